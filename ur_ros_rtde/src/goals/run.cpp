#include "ur_ros_rtde/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/detail/command_goal.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds feedback_period{50};
constexpr milliseconds max_sleep{10};
/// The control program starts a motion within this time after its acknowledgement: two cycles and a reserve.
constexpr std::chrono::seconds motion_start_timeout{1};
constexpr std::chrono::seconds package_timeout{1};
/// For the goals that a stop has preempted: they are abandoned before.
constexpr std::chrono::seconds release_timeout{6};
/// Without samples for this long, the connection is considered lost.
constexpr milliseconds max_sample_age{200};
constexpr double joint_tolerance = 0.005;     // rad
constexpr double position_tolerance = 0.002;  // m
constexpr double rotation_weight = 0.2;       // m/rad: 0.01 rad counts as 2 mm
constexpr std::chrono::minutes max_motion_duration{10};
/// For motions whose end the controller does not report: they end where the arm stands still.
constexpr double servo_joint_tolerance = 0.01;      // rad
constexpr double servo_position_tolerance = 0.004;  // m
constexpr std::chrono::seconds settling_timeout{2};

Vector6 nan_vector()
{
  Vector6 values;
  values.fill(std::numeric_limits<double>::quiet_NaN());
  return values;
}

/// m, with the rotation weighted by rotation_weight.
double pose_distance(const Vector6 & a, const Vector6 & b)
{
  const Vector6 difference = pose_trans(pose_inverse(a), b);
  return std::hypot(difference[0], difference[1], difference[2]) +
         rotation_weight * std::hypot(difference[3], difference[4], difference[5]);
}

Vector6 to_array(const std::vector<double> & values)
{
  if (values.size() != 6) {
    throw std::invalid_argument(fmt::format("6 values are needed, not {}", values.size()));
  }
  Vector6 array;
  std::copy(values.begin(), values.end(), array.begin());
  return array;
}

/// A timeout may be as long, or as negative, as a duration can be.
Clock::time_point deadline_in(std::chrono::nanoseconds timeout)
{
  const auto now = Clock::now();
  const auto left = std::max(timeout, std::chrono::nanoseconds(0));
  return left < Clock::time_point::max() - now ? now + left : Clock::time_point::max();
}

/// rad, largest difference of all joints.
std::function<double(const Sample &)> distance_to_joints(const std::vector<double> & positions)
{
  return [target = to_array(positions)](const Sample & sample) {
    double largest = 0.0;
    for (std::size_t i = 0; i < target.size(); ++i) {
      largest = std::max(largest, std::abs(target[i] - sample.actual_q[i]));
    }
    return largest;
  };
}

std::function<double(const Sample &)> distance_to_pose(const std::vector<double> & pose)
{
  return [target = to_array(pose)](const Sample & sample) {
    return pose_distance(sample.actual_tcp_pose, target);
  };
}
}  // namespace

ur_ros_rtde_msgs::msg::ArmState to_arm_state(const std::optional<Sample> & sample)
{
  ur_ros_rtde_msgs::msg::ArmState state;
  state.joint_positions = sample ? sample->actual_q : nan_vector();
  state.tcp_pose = to_ros(sample ? sample->actual_tcp_pose : nan_vector());
  return state;
}

Run::Run(RunContext context) : context_(std::move(context)), mark_(context_.robot.mark_motion()) {}

Locked<ur_rtde::RTDEControlInterface> Run::control()
{
  mark_ = robot().mark_motion();
  last_call_ = Clock::now();
  return context_.lease != nullptr ? context_.robot.control(*context_.lease) : context_.robot.control();
}

Expected<StopReport> Run::wait_for_stop()
{
  if (!context_.stopping) {
    return failure(ErrorCode::exception, "this command is not a stop");
  }
  while (context_.stopping->wait_for(max_sleep) != std::future_status::ready) {
    publish_feedback_if_due();
  }
  // The next goal of the client is to find nothing in its way.
  const auto deadline = Clock::now() + release_timeout;
  while (!robot().wait_for_stopped_holders(max_sleep) && Clock::now() < deadline) {
    publish_feedback_if_due();
  }
  return context_.stopping->get();
}

Sample Run::state() const
{
  if (auto sample = robot().latest()) {
    return *sample;
  }
  throw RobotError(Error{ErrorCode::link_lost, "no data has been received from the controller yet"});
}

ur_ros_rtde_msgs::msg::ArmState Run::arm_state() const
{
  return to_arm_state(robot().latest());
}

Vector6 Run::flange_force() const
{
  return tcp_frame_force(state());
}

std::optional<StopReason> Run::stop_reason() const
{
  if (auto why = context_.stop_request->reason()) {
    return why;
  }
  if (context_.lease != nullptr) {
    if (Status may = robot().may_continue(*context_.lease); !may) {
      return may.error();
    }
  }
  return std::nullopt;
}

std::optional<StopReason> Run::wait(const std::function<bool()> & condition, Clock::time_point deadline)
{
  Sample last = robot().latest().value_or(Sample{});
  while (true) {
    if (auto why = stop_reason()) {
      return why;
    }
    if (condition()) {
      return std::nullopt;
    }
    publish_feedback_if_due();
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
    if (left <= milliseconds(0)) {
      return Error{ErrorCode::timeout, "timed out"};
    }
    robot().wait_for_next(last, std::min(left, max_sleep), context_.stop_request->token());
  }
}

std::optional<StopReason> Run::sleep_for(std::chrono::nanoseconds duration)
{
  auto why = wait([] { return false; }, deadline_in(duration));
  return why && why->code == ErrorCode::timeout ? std::nullopt : why;
}

std::optional<StopReason> Run::until(const std::function<bool()> & condition,
                                     std::chrono::nanoseconds timeout)
{
  auto why = wait(condition, deadline_in(timeout));
  if (why && why->code == ErrorCode::timeout) {
    why->message =
        fmt::format("condition not met within {:.1f} s", std::chrono::duration<double>(timeout).count());
  }
  return why;
}

Outcome Run::expect(const std::function<bool()> & condition, std::chrono::nanoseconds timeout,
                    const std::string & otherwise, ErrorCode code)
{
  const auto why = wait(condition, deadline_in(timeout));
  if (!why) {
    return Outcome::success();
  }
  if (why->code != ErrorCode::timeout) {
    return *why;
  }
  // A lost connection does not stop a command that does not move the arm. The condition is then unknown, not
  // false.
  const auto age = Clock::now() - state().received;
  if (age < max_sample_age) {
    return Outcome::failure(code, otherwise);
  }
  return Outcome::failure(ErrorCode::link_lost,
                          fmt::format("no data has been received from the controller for {:.1f} s",
                                      std::chrono::duration<double>(age).count()));
}

std::optional<StopReason> Run::next(Sample & sample)
{
  // Counts waits, of which a suspension of this process is one: its packages are read next.
  for (auto waits = package_timeout / max_sleep; waits > 0; --waits) {
    if (auto why = stop_reason()) {
      return why;
    }
    publish_feedback_if_due();
    if (robot().wait_for_next(sample, max_sleep, context_.stop_request->token())) {
      return stop_reason();
    }
  }
  return Error{ErrorCode::link_lost, "no data has been received from the controller for 1 s"};
}

std::optional<StopReason> Run::until_standstill(std::chrono::nanoseconds timeout)
{
  auto why = until([this] { return robot().motion_progress(mark_).at_rest; }, timeout);
  if (why && why->code == ErrorCode::timeout) {
    why->message = "the arm did not come to a standstill: " + why->message;
  }
  return why;
}

bool Run::motion_ended() const
{
  const MotionProgress motion = robot().motion_progress(mark_);
  return motion.finished() || (!motion.started && Clock::now() - last_call_ > motion_start_timeout);
}

Outcome Run::until_motion_ends(std::chrono::nanoseconds timeout)
{
  if (auto why = until([this] { return motion_ended(); }, timeout)) {
    return *why;
  }
  if (!robot().motion_progress(mark_).started) {
    return Outcome::failure(ErrorCode::rejected_by_robot,
                            "the control program did not start the motion: see the log on the teach pendant");
  }
  return Outcome::success();
}

Outcome Run::until_reached(const Distance & distance, double tolerance, const char * unit)
{
  const double initial = distance(state());
  const auto update = [&] {
    const double left = distance(state());
    progress(initial > tolerance ? std::clamp(1.0 - left / initial, 0.0, 1.0) : 1.0);
    return motion_ended();
  };
  if (auto why = until(update, max_motion_duration)) {
    return *why;
  }
  const double left = distance(state());
  if (left <= tolerance) {
    progress(1.0);
    return Outcome::success();
  }
  if (Outcome ended = until_motion_ends(); !ended) {
    return ended;
  }
  return Outcome::failure(ErrorCode::not_reached,
                          fmt::format("the arm stopped {:.4f} {} before the target", left, unit));
}

Outcome Run::until_joints_reached(const std::vector<double> & positions)
{
  return until_reached(distance_to_joints(positions), joint_tolerance, "rad");
}

Outcome Run::until_pose_reached(const std::vector<double> & pose)
{
  return until_reached(distance_to_pose(pose), position_tolerance, "m");
}

Outcome Run::until_at(const Distance & distance, double tolerance, const char * unit)
{
  const double initial = std::max(distance(state()), tolerance);
  auto last_moved = Clock::now();
  bool reached = false;
  const auto update = [&] {
    const double left = distance(state());
    progress(std::max(progress(), std::clamp(1.0 - left / initial, 0.0, 1.0)));
    const bool at_rest = robot().motion_progress(mark_).at_rest;
    last_moved = at_rest ? last_moved : Clock::now();
    reached = at_rest && left <= tolerance;
    return reached || Clock::now() - last_moved > settling_timeout;
  };
  if (auto why = until(update, max_motion_duration)) {
    return *why;
  }
  if (reached) {
    progress(1.0);
    return Outcome::success();
  }
  return Outcome::failure(ErrorCode::not_reached, fmt::format("the arm stopped {:.4f} {} before the target",
                                                              distance(state()), unit));
}

Outcome Run::until_at_rest_at_joints(const std::vector<double> & positions)
{
  return until_at(distance_to_joints(positions), servo_joint_tolerance, "rad");
}

Outcome Run::until_at_rest_at_pose(const std::vector<double> & pose)
{
  return until_at(distance_to_pose(pose), servo_position_tolerance, "m");
}

Outcome Run::stop_motion(StopOptions options)
{
  if (context_.lease == nullptr) {
    return Outcome::failure(ErrorCode::exception, "a command without Resource::motion has nothing to stop");
  }
  options.keep = robot().activities() & outlasting_modes;
  return stop_except_kept(options);
}

Status Run::stop_except_kept(const StopOptions & options)
{
  if (robot().is_at_rest_except(options.keep)) {
    return {};
  }
  const auto stopped = context_.robot.pause_motion(*context_.lease, options);
  return stopped ? Status() : tl::unexpected(stopped.error());
}

ScriptReport Run::run_script(const std::string & script, ScriptOptions options)
{
  options.stop_reason = [this] {
    publish_feedback_if_due();
    return context_.stop_request->reason();  // the script replaces the control program, which is no reason
  };
  const Lease none;
  return context_.robot.run_script(context_.lease != nullptr ? *context_.lease : none, script, options);
}

std::optional<ur_ros_rtde_msgs::msg::MotionFeedback> Run::motion_feedback() const
{
  const auto sample = robot().latest();
  if (!sample) {
    return std::nullopt;
  }
  ur_ros_rtde_msgs::msg::MotionFeedback feedback;
  feedback.progress = progress_;
  const std::chrono::nanoseconds since = elapsed();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  feedback.elapsed.sec = static_cast<std::int32_t>(seconds.count());
  feedback.elapsed.nanosec = static_cast<std::uint32_t>((since - seconds).count());
  feedback.state = to_arm_state(sample);
  return feedback;
}

void Run::publish_feedback_if_due()
{
  const auto now = Clock::now();
  if (now < next_feedback_) {
    return;
  }
  next_feedback_ = std::max(next_feedback_ + feedback_period, now);
  publish_feedback();
}

void Run::warn(const std::string & text)
{
  context_.log_warning(text);
  warnings_ += warnings_.empty() ? text : "; " + text;
}

Outcome Run::with_warnings(const Outcome & outcome) const
{
  if (warnings_.empty()) {
    return outcome;
  }
  return Error{outcome.code(), outcome.message().empty() ? warnings_ : outcome.message() + "; " + warnings_};
}

Outcome Run::trigger(double timeout)
{
  constexpr double max_timeout = 86400.0;  // s
  if (!(timeout > 0.0 && timeout <= max_timeout)) {
    return Outcome::failure(
        ErrorCode::invalid_goal,
        fmt::format("the timeout of the extension is {} s, it must be above 0 and at most {} s", timeout,
                    max_timeout));
  }
  if (context_.lease == nullptr || context_.command == nullptr) {
    return Outcome::failure(ErrorCode::exception, "an extension needs Resource::motion");
  }
  ExtensionOptions options;
  options.timeout =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(timeout));
  options.stop_reason = [this] {
    publish_feedback_if_due();
    return stop_reason();
  };
  return context_.robot.run_extension(*context_.lease, context_.command->plugin, options);
}

}  // namespace ur_ros_rtde
