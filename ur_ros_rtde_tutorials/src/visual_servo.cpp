#include <algorithm>
#include <cmath>
#include <cstdint>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <limits>
#include <mutex>
#include <ur_ros_rtde/command.hpp>
#include <ur_ros_rtde/streaming.hpp>
#include <ur_ros_rtde/target_messages.hpp>
#include <ur_ros_rtde_robot/state/conversions.hpp>
#include <ur_ros_rtde_tutorials/action/visual_servo.hpp>
#include <utility>

namespace ur_ros_rtde_tutorials {

using geometry_msgs::msg::PoseStamped;
using ur_ros_rtde::Check;
using ur_ros_rtde::CommandHost;
using ur_ros_rtde::Expected;
using ur_ros_rtde::Outcome;
using ur_ros_rtde::rotate;
using ur_ros_rtde::rotation;
using ur_ros_rtde::Status;
using ur_ros_rtde::StreamOptions;
using ur_ros_rtde::StreamTarget;
using ur_ros_rtde::TargetStream;
using ur_ros_rtde::Vector3;
using ur_ros_rtde::Vector6;

namespace {

/// The newest message of the camera, or what is wrong with it.
struct Measurement {
  std::uint64_t number = 0;
  Expected<StreamTarget> target = StreamTarget{};
};

/// rad, of the orientation.
constexpr double turn_tolerance = 0.02;

/// How far the axes of the tool are turned: rad, for small angles.
double turn(const Vector6 & a, const Vector6 & b)
{
  double farthest = 0.0;
  for (const Vector3 & axis : {Vector3{1.0, 0.0, 0.0}, Vector3{0.0, 1.0, 0.0}, Vector3{0.0, 0.0, 1.0}}) {
    const Vector3 p = rotate(rotation(a), axis);
    const Vector3 q = rotate(rotation(b), axis);
    farthest = std::max(farthest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  return farthest;
}

double distance(const Vector6 & a, const Vector6 & b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

class VisualServo : public ur_ros_rtde::Command<action::VisualServo> {
 public:
  void on_load(CommandHost & host) override
  {
    camera_ = host.node().create_subscription<PoseStamped>(
        "visual_servo/target", rcl_cxx::QoS::best_effort(1),
        [this, &host](const PoseStamped & message) {
          Expected<StreamTarget> target = ur_ros_rtde::pose_target(message, host.options().tf_prefix);
          const std::lock_guard lock(mutex_);
          newest_ = {newest_.number + 1, std::move(target)};
        },
        host.callbacks());
  }
  void on_unload() override { camera_.reset(); }

 private:
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("tolerance", goal.tolerance, 0.0005, 0.1, "m")
        .in_range("settling_time", goal.settling_time, 0.0, 10.0, "s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    // The first target may be far away: the arm moves there at its default speed.
    const StreamOptions options{.timeout = 0.5, .max_joint_jump = 0.5, .max_linear_jump = 0.3};
    TargetStream stream(run, ur_ros_rtde::follow_poses(options), options);
    Measurement seen = newest();                               // older than this goal
    double arrival = std::numeric_limits<double>::infinity();  // s of the controller
    while (true) {
      if (auto why = stream.wait()) {
        return *why;
      }
      if (Measurement now = newest(); now.number != std::exchange(seen, now).number) {
        if (!now.target) {
          return now.target.error();
        }
        if (Status valid = stream.set(*now.target); !valid) {
          return valid;
        }
        const Vector6 & pose = stream.sample().actual_tcp_pose;
        run.feedback().distance = distance(now.target->values, pose);
        const bool is_there =
            run.feedback().distance <= goal.tolerance && turn(now.target->values, pose) <= turn_tolerance;
        arrival = is_there ? std::min(arrival, stream.sample().controller_time)
                           : std::numeric_limits<double>::infinity();
      }
      if (stream.sample().controller_time - arrival >= goal.settling_time) {
        return run.stop_motion(options.stop_options());
      }
      if (Status sent = stream.send(); !sent) {
        return sent;
      }
    }
  }

  Measurement newest() const
  {
    const std::lock_guard lock(mutex_);
    return newest_;
  }

  mutable std::mutex mutex_;
  Measurement newest_;
  rcl_cxx::Subscription<PoseStamped>::SharedPtr camera_;
};

UR_ROS_RTDE_EXPORT(VisualServo, "visual_servo")

}  // namespace ur_ros_rtde_tutorials
