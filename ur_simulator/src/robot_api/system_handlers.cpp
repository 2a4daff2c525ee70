#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>

#include "robot_api/handlers.hpp"
#include "robot_api/openapi.hpp"

namespace ur_simulator::robot_api {
namespace {

/// "UR7" for the model ur7e, "UR8LONG" for ur8long.
std::string robot_type(const RobotModel & model)
{
  std::string type = model.name;
  if (model.series == Series::e_series && type.ends_with('e')) {
    type.pop_back();
  }
  std::ranges::transform(type, type.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return type;
}

}  // namespace

Answer get_control_mode(const Call & call)
{
  return json_reply(200,
                    {{"mode", call.pendant.remote_control() ? "REMOTE" : "LOCAL"}, {"message", nullptr}});
}

Answer get_operational_mode(const Call & call)
{
  return json_reply(200,
                    {{"mode", call.pendant.in_manual_mode() ? "MANUAL" : "AUTOMATIC"}, {"message", nullptr}});
}

Answer get_information(const Call & call)
{
  return json_reply(200, {{"robotType", robot_type(call.pendant.model())},
                          {"serialNumber", call.pendant.options().serial_number}});
}

Answer get_versions(const Call & call)
{
  const PolyscopeVersion & version = call.pendant.options().version;
  return json_reply(
      200, {{"marketingVersion", fmt::format("{}.{}.{}", version.major, version.minor, version.bugfix)},
            {"baselineVersion", version.to_string()}});
}

Answer get_system_time(const Call &)
{
  const std::time_t now = std::time(nullptr);
  return json_reply(
      200, {{"systemTime", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))}, {"message", nullptr}});
}

Answer add_to_log(const Call & call)
{
  call.pendant.log().info("robot_api", call.body.at("message").get<std::string>());
  return json_reply(200, {{"message", "Log entry added"}});
}

Answer shut_down(const Call & call)
{
  // The shutdown closes the connections: the reply is sent before.
  return [&pendant = call.pendant]() -> std::optional<Reply> {
    pendant.request_shutdown();
    return json_reply(202, {{"message", nullptr}});
  };
}

Answer get_openapi(const Call & call)
{
  return json_reply(200, openapi_document(call.pendant.options().version));
}

}  // namespace ur_simulator::robot_api
