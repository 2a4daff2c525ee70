#include "ur_ros_rtde/digital_output.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_io_interface.h>

namespace ur_ros_rtde {
namespace {

bool send_digital_output(ur_rtde::RTDEIOInterface & io, unsigned number, bool state)
{
  const auto pin = [number](unsigned first) { return static_cast<std::uint8_t>(number - first); };
  if (number < first_configurable_output) {
    return io.setStandardDigitalOut(pin(0), state);
  }
  if (number < first_tool_output) {
    return io.setConfigurableDigitalOut(pin(first_configurable_output), state);
  }
  return io.setToolDigitalOut(pin(first_tool_output), state);
}

}  // namespace

Outcome set_digital_output(Run & run, unsigned number, bool state)
{
  if (!send_digital_output(*run.io().hold(), number, state)) {
    return Outcome::failure(ErrorCode::link_lost, "the value could not be sent to the robot: try again");
  }
  const auto is_set = [&] { return (((run.state().digital_outputs >> number) & 1U) != 0) == state; };
  return run.expect(is_set, std::chrono::seconds(1),
                    fmt::format("digital output {} is still {}: check in the installation on the robot "
                                "whether another function is assigned to it",
                                number, state ? "off" : "on"));
}

}  // namespace ur_ros_rtde
