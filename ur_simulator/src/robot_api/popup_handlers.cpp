#include "robot_api/handlers.hpp"

namespace ur_simulator::robot_api {
namespace {

Reply closed_reply(bool closed, std::string_view message)
{
  return json_reply(closed ? 200 : 404, {{"closed", closed}, {"message", message}});
}

}  // namespace

Answer open_popup(const Call & call)
{
  urscript::Popup popup;
  popup.message = call.body.at("message").get<std::string>();
  popup.title = call.body.value("title", "");
  call.pendant.runner().show_popup(popup);
  return json_reply(200, {{"message", "Popup opened successfully"}});
}

Answer close_popup(const Call & call)
{
  const bool open = call.pendant.runner().popup().has_value();
  call.pendant.runner().close_popup();
  return closed_reply(open, open ? "Popup closed" : "No popup is open");
}

Answer close_safety_popup(const Call & call)
{
  const bool open = call.pendant.safety_popup().has_value();
  call.pendant.close_safety_popup();
  return closed_reply(open, open ? "Safety popup closed" : "No safety popup is open");
}

}  // namespace ur_simulator::robot_api
