#include <ur_ros_rtde_msgs/action/get_flag.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class IsProgramRunning : public QueryCommand<ur_ros_rtde_msgs::action::GetFlag> {
  Outcome run(const Goal &, Run & run) override
  {
    run.result().value = run.state().is_program_running();
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(IsProgramRunning, "is_program_running")

}  // namespace ur_ros_rtde
