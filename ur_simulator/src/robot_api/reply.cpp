#include "robot_api/reply.hpp"

namespace ur_simulator::robot_api {

using nlohmann::json;

Reply json_reply(unsigned status, const json & body)
{
  // Texts of clients may be no valid UTF-8.
  return {.status = status, .body = body.dump(-1, ' ', false, json::error_handler_t::replace)};
}

Reply error_reply(unsigned status, std::string_view message, std::string_view details)
{
  return json_reply(status, {{"message", message}, {"details", details}});
}

Reply validation_error(std::vector<std::string> location, std::string_view message)
{
  const json error{{"type", "value_error"}, {"loc", std::move(location)}, {"msg", message}};
  return json_reply(422, {{"detail", json::array({error})}});
}

}  // namespace ur_simulator::robot_api
