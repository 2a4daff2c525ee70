#pragma once

#include <rcl_action/types.h>

#include <action_msgs/msg/goal_status_array.hpp>
#include <action_msgs/srv/cancel_goal.hpp>
#include <algorithm>
#include <iterator>

#include "rcl_cxx/goal_uuid.hpp"

/// Conversions between the C messages of rcl_action and the C++ messages that are sent.
namespace rcl_cxx::detail {
inline GoalUUID to_goal_id(const rcl_action_goal_info_t & info)
{
  GoalUUID id;
  std::copy(std::begin(info.goal_id.uuid), std::end(info.goal_id.uuid), id.bytes.begin());
  return id;
}

inline rcl_action_goal_info_t to_c(const action_msgs::msg::GoalInfo & info)
{
  rcl_action_goal_info_t result = rcl_action_get_zero_initialized_goal_info();
  std::copy(info.goal_id.uuid.begin(), info.goal_id.uuid.end(), std::begin(result.goal_id.uuid));
  result.stamp.sec = info.stamp.sec;
  result.stamp.nanosec = info.stamp.nanosec;
  return result;
}

inline action_msgs::msg::GoalInfo to_cpp(const rcl_action_goal_info_t & info)
{
  action_msgs::msg::GoalInfo result;
  result.goal_id.uuid = to_goal_id(info).bytes;
  result.stamp.sec = info.stamp.sec;
  result.stamp.nanosec = info.stamp.nanosec;
  return result;
}

inline action_msgs::msg::GoalStatusArray to_cpp(const action_msgs__msg__GoalStatusArray & array)
{
  action_msgs::msg::GoalStatusArray result;
  result.status_list.resize(array.status_list.size);
  for (std::size_t i = 0; i < array.status_list.size; ++i) {
    result.status_list[i].goal_info = to_cpp(array.status_list.data[i].goal_info);
    result.status_list[i].status = array.status_list.data[i].status;
  }
  return result;
}

}  // namespace rcl_cxx::detail
