#include "state/driver_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "state/active_modes.hpp"

namespace ur_ros_rtde {
namespace {
using Message = ur_ros_rtde_msgs::msg::DriverState;

std::uint8_t number(RobotState state)
{
  switch (state) {
    case RobotState::connecting:
      return Message::CONNECTING;
    case RobotState::ready:
      return Message::READY;
    case RobotState::stopped:
      return Message::STOPPED;
    default:
      return Message::DISCONNECTED;
  }
}

const char * name(RobotState state)
{
  switch (state) {
    case RobotState::connecting:
      return "CONNECTING";
    case RobotState::ready:
      return "READY";
    case RobotState::stopped:
      return "STOPPED";
    default:
      return "DISCONNECTED";
  }
}

std::uint8_t level(const RobotStatus & status)
{
  switch (status.state) {
    case RobotState::ready:
      return Diagnosis::Status::OK;
    case RobotState::connecting:
      return Diagnosis::Status::WARN;
    case RobotState::stopped:
      return status.cause == ErrorCode::emergency_stop || status.cause == ErrorCode::safety_violation
                 ? Diagnosis::Status::ERROR
                 : Diagnosis::Status::WARN;
    default:
      return Diagnosis::Status::ERROR;
  }
}

std::string holder(const Robot & robot, Resource resource)
{
  const auto found = robot.holder(resource);
  return found ? fmt::format("{}, goal {}", found->owner, found->id) : "none";
}
}  // namespace

DriverStateTopic::DriverStateTopic(rcl_cxx::Node & node)
    : node_(node), publisher_(node.create_publisher<Message>("driver_state", rcl_cxx::QoS::transient_local()))
{
  publish({RobotState::disconnected, ErrorCode::link_lost, "not yet connected"});
}

void DriverStateTopic::publish(const RobotStatus & status)
{
  Message message;
  message.stamp = node_.now();
  message.state = number(status.state);
  message.name = name(status.state);
  message.cause = static_cast<std::uint16_t>(status.cause);
  message.message = status.message;
  publisher_->publish(message);
}

std::vector<Diagnosis> diagnose_driver(Robot & robot)
{
  const RobotStatus status = robot.status();
  Diagnosis diagnosis("driver");
  diagnosis.add(level(status), status.message.empty() ? "ready for commands" : status.message)
      .value("state", name(status.state))
      .value("cause", to_string(status.cause))
      .value("model", robot.model().empty() ? "unknown" : robot.model())
      .value("active modes", fmt::format("{}", fmt::join(mode_names(robot.activities()), ", ")))
      .value("motion goal", holder(robot, Resource::motion))
      .value("io goal", holder(robot, Resource::io))
      .value("script goal", holder(robot, Resource::script));
  const Status control = robot.motion_possible();
  diagnosis.value("control program", control ? "runs" : control.error().message);
  return {std::move(diagnosis)};
}

}  // namespace ur_ros_rtde
