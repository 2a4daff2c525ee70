#include <stdexcept>

#include "ur_ros_rtde/detail/command_goal.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

void Run::unless_stopped(const std::function<void()> & request) const
{
  if (context_.command == nullptr) {
    throw std::logic_error("Run::unless_stopped() needs a goal");
  }
  const auto under_way = context_.command->host.begin_startup_request(context_.stops_before);
  if (const auto why = context_.stop_request->reason()) {
    throw RobotError(*why);
  }
  if (!under_way) {
    throw RobotError(stopped_by_the_driver());
  }
  request();
}

}  // namespace ur_ros_rtde
