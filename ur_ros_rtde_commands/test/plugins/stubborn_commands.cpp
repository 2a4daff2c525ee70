// Commands of the stop property test that do not end soon after they have to.
#include <chrono>
#include <stdexcept>
#include <thread>
#include <ur_ros_rtde_msgs/action/dashboard_query.hpp>
#include <ur_ros_rtde_msgs/action/speed_j.hpp>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;
using SpeedJAction = ur_ros_rtde_msgs::action::SpeedJ;

Clock::time_point end_of(const SpeedJAction::Goal & goal)
{
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(goal.time));
}

}  // namespace

/// Its check takes `check_time` ms, which it must not.
template <int check_time>
class SlowCheck : public Command<SpeedJAction> {
  void check(const Goal &, Check & check) const override
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(check_time));
    check.start();
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> velocities(goal.joint_velocities.begin(), goal.joint_velocities.end());
    run.control()->speedJ(velocities, goal.acceleration, goal.time);
    return Outcome::success();
  }
};

using SlowToCheck = SlowCheck<300>;
using VerySlowToCheck = SlowCheck<2000>;

/// Computes for 200 ms between two looks at the reason to stop, while the arm moves.
class SlowToLook : public Command<SpeedJAction> {
  StopOptions stop_options(const Goal & goal) const override
  {
    return {.joint_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    constexpr std::chrono::milliseconds computing_time{200};
    const std::vector<double> velocities(goal.joint_velocities.begin(), goal.joint_velocities.end());
    for (const auto end = end_of(goal); Clock::now() < end;) {
      if (auto why = run.stop_reason()) {
        return *why;
      }
      run.control()->speedJ(velocities, goal.acceleration, 0.0);
      std::this_thread::sleep_for(computing_time);
    }
    return Outcome::success();
  }
};

/// Sends commands until its time has passed, without asking whether it has to end.
class NeverLooks : public Command<SpeedJAction> {
  StopOptions stop_options(const Goal & goal) const override
  {
    return {.joint_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    constexpr std::chrono::milliseconds period{20};
    const std::vector<double> velocities(goal.joint_velocities.begin(), goal.joint_velocities.end());
    for (const auto end = end_of(goal); Clock::now() < end; std::this_thread::sleep_for(period)) {
      try {
        run.control()->speedJ(velocities, goal.acceleration, 0.0);
      } catch (const std::exception &) {
        continue;  // this is what it never looks at
      }
    }
    return Outcome::success();
  }
};

/// Turns joints until the connection is another one, and does not look at more than that.
class OutlastsTheLink : public Command<SpeedJAction> {
  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedJ({goal.joint_velocities.begin(), goal.joint_velocities.end()}, goal.acceleration,
                          0.0);
    constexpr std::chrono::milliseconds period{5};
    const auto link = run.state().link;
    for (const auto end = end_of(goal); run.state().link == link && Clock::now() < end;) {
      std::this_thread::sleep_for(period);
    }
    return Outcome::success();
  }
};

/// Turns joints with the resource of a mode, hangs while they turn, and switches an output on then.
class TurnsAndHangs : public Command<SpeedJAction> {
  CommandTraits traits() const override { return {.resource = Resource::mode}; }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> velocities(goal.joint_velocities.begin(), goal.joint_velocities.end());
    run.control()->speedJ(velocities, goal.acceleration, 0.0);
    std::this_thread::sleep_until(end_of(goal));
    run.io()->setStandardDigitalOut(0, true);
    return Outcome::success();
  }
};

/// Turns joints while a timer of its own keeps the thread that accepts goals for 5 s.
class BlocksCallbacks : public Command<SpeedJAction> {
 public:
  void on_load(CommandHost & host) override
  {
    timer_ = host.node().create_wall_timer(std::chrono::milliseconds(1), [this] {
      timer_->cancel();
      std::this_thread::sleep_for(std::chrono::seconds(5));
    });
    timer_->cancel();  // until there is a goal
  }
  void on_unload() override { timer_.reset(); }

 private:
  Outcome run(const Goal & goal, Run & run) override
  {
    timer_->reset();
    run.control()->speedJ({goal.joint_velocities.begin(), goal.joint_velocities.end()}, goal.acceleration,
                          0.0);
    const auto why = run.sleep_for(end_of(goal) - Clock::now());
    return why ? Outcome(*why) : Outcome::success();
  }

  rcl_cxx::Timer::SharedPtr timer_;
};

class Fails : public Command<SpeedJAction> {
  Outcome run(const Goal &, Run &) override { throw std::runtime_error("the gripper is broken"); }
};

/// A dashboard command whose check takes 2 s, which it must not.
class DashboardSlowToCheck : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  void check(const Goal &, Check &) const override { std::this_thread::sleep_for(std::chrono::seconds(2)); }
  Outcome run(const Goal &, Run &) override { return Outcome::success(); }
};

/// A dashboard command that hangs for 4 s, less than the driver waits for it at its end.
class Hangs : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Outcome run(const Goal &, Run &) override
  {
    std::this_thread::sleep_for(std::chrono::seconds(4));
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(SlowToCheck, "slow_to_check")
UR_ROS_RTDE_EXPORT(VerySlowToCheck, "very_slow_to_check")
UR_ROS_RTDE_EXPORT(SlowToLook, "slow_to_look")
UR_ROS_RTDE_EXPORT(NeverLooks, "never_looks")
UR_ROS_RTDE_EXPORT(OutlastsTheLink, "outlasts_the_link")
UR_ROS_RTDE_EXPORT(TurnsAndHangs, "turns_and_hangs")
UR_ROS_RTDE_EXPORT(BlocksCallbacks, "blocks_callbacks")
UR_ROS_RTDE_EXPORT(Fails, "fails")
UR_ROS_RTDE_EXPORT(DashboardSlowToCheck, "dashboard/slow_to_check")
UR_ROS_RTDE_EXPORT(Hangs, "dashboard/hangs")

}  // namespace ur_ros_rtde
