#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

const char * to_string(ErrorCode code)
{
  switch (code) {
    case ErrorCode::none:
      return "none";
    case ErrorCode::invalid_goal:
      return "invalid_goal";
    case ErrorCode::busy:
      return "busy";
    case ErrorCode::not_ready:
      return "not_ready";
    case ErrorCode::canceled:
      return "canceled";
    case ErrorCode::preempted:
      return "preempted";
    case ErrorCode::timeout:
      return "timeout";
    case ErrorCode::protective_stop:
      return "protective_stop";
    case ErrorCode::emergency_stop:
      return "emergency_stop";
    case ErrorCode::safeguard_stop:
      return "safeguard_stop";
    case ErrorCode::program_stopped:
      return "program_stopped";
    case ErrorCode::link_lost:
      return "link_lost";
    case ErrorCode::rejected_by_robot:
      return "rejected_by_robot";
    case ErrorCode::not_reached:
      return "not_reached";
    case ErrorCode::unreachable:
      return "unreachable";
    case ErrorCode::exception:
      return "exception";
    case ErrorCode::shutdown:
      return "shutdown";
    case ErrorCode::not_supported:
      return "not_supported";
    case ErrorCode::safety_violation:
      return "safety_violation";
    case ErrorCode::client_lost:
      return "client_lost";
    case ErrorCode::model_mismatch:
      return "model_mismatch";
    case ErrorCode::robot_in_use:
      return "robot_in_use";
  }
  return "unknown";
}

}  // namespace ur_ros_rtde
