#include "ur_ros_rtde/run.hpp"

#include <fmt/format.h>

#include <algorithm>
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
/// For the goals that a stop has preempted: they are abandoned before.
constexpr std::chrono::seconds release_timeout{6};

Vector6 nan_vector()
{
  Vector6 values;
  values.fill(std::numeric_limits<double>::quiet_NaN());
  return values;
}
}  // namespace

ur_ros_rtde_msgs::msg::ArmState to_arm_state(const std::optional<Sample> & sample)
{
  ur_ros_rtde_msgs::msg::ArmState state;
  state.joint_positions = sample ? sample->actual_q : nan_vector();
  state.tcp_pose = to_ros(sample ? sample->actual_tcp_pose : nan_vector());
  return state;
}

Run::Run(RunContext context)
    : context_(std::move(context)), call_{context_.robot.mark_motion(), begin_}, motion_(call_)
{
}

Outcome Run::check_again(const std::function<void(Check &)> & check)
{
  Check again(&context_.robot);
  check(again);
  return again.ask(context_.robot);
}

Locked<ur_rtde::RTDEControlInterface> Run::control()
{
  motion_ = motion();
  call_ = {robot().mark_motion(), Clock::now()};
  const auto control =
      context_.lease != nullptr ? context_.robot.control(*context_.lease) : control_for_queries();
  return control_timeout_.count() > 0 ? control.before_others(control_timeout_) : control;
}

Locked<ur_rtde::RTDEIOInterface> Run::io() const
{
  require_unsent_result();
  return context_.robot.io();
}

Locked<ur_rtde::DashboardClient> Run::dashboard() const
{
  require_unsent_result();
  return context_.robot.dashboard();
}

bool Run::is_abandoned() const
{
  return context_.stop_request->is_abandoned();
}

void Run::require_unsent_result() const
{
  if (is_abandoned()) {
    throw RobotError(context_.stop_request->reason().value());
  }
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

Expected<Vector6> Run::frame(const std::string & frame_id, std::chrono::nanoseconds timeout) const
{
  return context_.command != nullptr
             ? context_.command->host.frames().pose(frame_id, context_.stop_request->token(), timeout)
             : failure(ErrorCode::not_supported, "a topic of teleoperation has no frames of TF");
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

Outcome Run::stop_motion(std::optional<StopOptions> options)
{
  if (context_.lease == nullptr) {
    return Outcome::failure(ErrorCode::exception, "a command without Resource::motion has nothing to stop");
  }
  if (context_.command != nullptr && context_.command->traits.resource == Resource::mode &&
      robot().holder(Resource::motion)) {
    return Outcome::success();  // what moves belongs to another goal
  }
  StopOptions chosen = options ? *options : context_.stop_options();
  chosen.keep = robot().activities() & outlasting_modes;
  return stop_except_kept(chosen);
}

Status Run::stop_except_kept(const StopOptions & options)
{
  if (robot().is_at_rest_except(options.keep)) {
    return {};
  }
  // Contact detection stays armed until the arm has to be stopped, or until the end of the goal.
  const Activities left = robot().activities().without(options.keep);
  if (left == Activities(Activity::contact_detection) && !robot().is_moving()) {
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
  options.stop = context_.stop_request->token();
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

Run::Braking Run::brake_by_itself() const
{
  if (context_.lease == nullptr || !*context_.lease) {
    throw RobotError({ErrorCode::exception, "a command without Resource::motion has nothing to stop"});
  }
  return Braking(*context_.lease);
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
