#include <ur_ros_rtde_msgs/action/get_integer.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetAsyncOperationProgress : public QueryCommand<ur_ros_rtde_msgs::action::GetInteger> {
  Outcome run(const Goal &, Run & run) override
  {
    const AsyncStatus status = run.state().async;
    run.result().value = status.running() ? static_cast<std::int64_t>(status.progress()) : -1;
    run.result().text =
        fmt::format("operation {} {}", status.operation(),
                    status.running() ? fmt::format("is at waypoint {}", status.progress()) : "has ended");
    return Outcome::success(run.result().text);
  }
};

UR_ROS_RTDE_EXPORT(GetAsyncOperationProgress, "get_async_operation_progress")

}  // namespace ur_ros_rtde
