#pragma once

#include <memory>
#include <string>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/dashboard_run.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/plugin.hpp"

namespace ur_ros_rtde {

/// The part of DashboardCommand<A> that does not depend on the type of the action.
class DashboardCommandBase : public DashboardPlugin, private GoalServer {
 public:
  virtual DashboardLimits limits() const { return {}; }

  void start_action_server(DashboardHost & host, const std::string & name) override;
  void stop_action_server() override { stop_server(); }

 private:
  virtual const rcl_cxx::ActionType & action_type() const = 0;
  virtual void check_goal(const void * goal, Check & check) const = 0;
  virtual std::unique_ptr<DashboardRun> make_run(DashboardConnection & connection,
                                                 std::shared_ptr<StopRequest> stop_request,
                                                 PublishFeedback publish) const = 0;
  virtual Outcome run_goal(const void * goal, DashboardRun & run) = 0;

  rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const void * goal) override;
  void execute_goal(Handle & handle, GoalContext & context) override;
  void abort_unstarted(Handle & handle, const Outcome & outcome) override;

  DashboardConnection * connection_ = nullptr;
  std::unique_ptr<ActiveGoals> goals_;
};

}  // namespace ur_ros_rtde
