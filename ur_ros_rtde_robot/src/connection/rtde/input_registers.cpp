#include "connection/rtde/input_registers.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_io_interface.h>

#include "ur_ros_rtde_robot/connection/text.hpp"
#include "ur_ros_rtde_robot/script/extension_registers.hpp"

namespace ur_ros_rtde {
Status InputRegisters::check(int index)
{
  if (script::free_inputs.contains(index)) {
    return {};
  }
  return failure(ErrorCode::invalid_goal, fmt::format("input register {}: extensions may use {}", index,
                                                      script::to_string(script::free_inputs)));
}

Status InputRegisters::write(const std::string & what,
                             const std::function<bool(ur_rtde::RTDEIOInterface &)> & write_to,
                             const Permission & permission) const
{
  try {
    const auto io = interfaces_.io();
    if (io && write_to(*io->permitted_by(permission).hold())) {
      return {};
    }
    return failure(ErrorCode::link_lost, fmt::format("{} was not sent", what));
  } catch (const RobotError & error) {
    return tl::unexpected(error.error());
  } catch (const std::exception & error) {
    return failure(ErrorCode::link_lost, fmt::format("{} was not sent: {}", what, printable(error.what())));
  }
}

Status InputRegisters::set(int index, std::int32_t value) const
{
  if (auto valid = check(index); !valid) {
    return valid;
  }
  return write(fmt::format("input integer register {}", index),
               [&](ur_rtde::RTDEIOInterface & io) { return io.setInputIntRegister(index + offset_, value); });
}

Status InputRegisters::set(int index, double value) const
{
  if (auto valid = check(index); !valid) {
    return valid;
  }
  return write(fmt::format("input float register {}", index), [&](ur_rtde::RTDEIOInterface & io) {
    return io.setInputDoubleRegister(index + offset_, value);
  });
}

Status InputRegisters::set_trigger(int id, const Permission & permission)
{
  const Trigger trigger{id, interfaces_.starts()};
  if (id != 0) {
    trigger_ = trigger;  // even if it turns out that it was not sent
  }
  Status sent = write(
      "the trigger of the extension",
      [&](ur_rtde::RTDEIOInterface & io) {
        return io.setInputDoubleRegister(script::trigger_register + offset_, id);
      },
      permission);
  if (sent) {
    trigger_ = trigger;
  }
  return sent;
}

bool InputRegisters::extension_started() const
{
  const Trigger trigger = trigger_;
  return trigger.id != 0 && trigger.program == interfaces_.starts();
}

}  // namespace ur_ros_rtde
