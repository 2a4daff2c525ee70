#include "connection/rtde/input_registers.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_io_interface.h>

#include "ur_ros_rtde_robot/connection/text.hpp"
#include "ur_ros_rtde_robot/script/extension_registers.hpp"

namespace ur_ros_rtde {
namespace {

/// Like the one of a stop for the control interface.
constexpr std::chrono::milliseconds clear_timeout(12);

}  // namespace

Status InputRegisters::check(int index)
{
  if (script::free_inputs.contains(index)) {
    return {};
  }
  return failure(ErrorCode::invalid_goal, fmt::format("input register {}: extensions may use {}", index,
                                                      script::to_string(script::free_inputs)));
}

Status InputRegisters::write(const std::string & what, const std::optional<Io> & io,
                             const std::function<bool(ur_rtde::RTDEIOInterface &)> & write_to)
{
  try {
    if (io && write_to(*io->hold())) {
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
  return write(fmt::format("input integer register {}", index), interfaces_.io(),
               [&](ur_rtde::RTDEIOInterface & io) { return io.setInputIntRegister(index + offset_, value); });
}

Status InputRegisters::set(int index, double value) const
{
  if (auto valid = check(index); !valid) {
    return valid;
  }
  return write(
      fmt::format("input float register {}", index), interfaces_.io(),
      [&](ur_rtde::RTDEIOInterface & io) { return io.setInputDoubleRegister(index + offset_, value); });
}

Status InputRegisters::set_trigger(int id, const Permission & permission)
{
  const auto io = interfaces_.io();
  return write_trigger(id, io ? std::optional(io->permitted_by(permission)) : std::nullopt);
}

Status InputRegisters::clear_trigger()
{
  const auto io = interfaces_.io();
  return write_trigger(0, io ? std::optional(io->before_others(clear_timeout)) : std::nullopt);
}

Status InputRegisters::write_trigger(int id, const std::optional<Io> & io)
{
  const Trigger trigger{id, interfaces_.starts().number};
  if (id != 0) {
    trigger_ = trigger;  // even if it turns out that it was not sent
  }
  Status sent = write("the trigger of the extension", io, [&](ur_rtde::RTDEIOInterface & locked) {
    return locked.setInputDoubleRegister(script::trigger_register + offset_, id);
  });
  if (sent) {
    trigger_ = trigger;
  }
  return sent;
}

bool InputRegisters::extension_started() const
{
  const Trigger trigger = trigger_;
  return trigger.id != 0 && trigger.program == interfaces_.starts().number;
}

}  // namespace ur_ros_rtde
