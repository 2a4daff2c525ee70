// What a command waits for: time, conditions, samples, the ends of motions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds longest_wait{10};
/// The control program starts a motion within this time after its acknowledgement: two cycles and a reserve.
constexpr std::chrono::seconds motion_start_timeout{1};
constexpr std::chrono::seconds package_timeout{1};
/// Without samples for this long, the connection is considered lost.
constexpr milliseconds max_sample_age{200};
constexpr double joint_tolerance = 0.005;     // rad
constexpr double position_tolerance = 0.002;  // m
constexpr double rotation_weight = 0.2;       // m/rad: 0.01 rad counts as 2 mm
constexpr std::chrono::minutes max_motion_duration{10};
/// For motions whose end the controller does not report: they end where the arm comes to rest.
constexpr double servo_joint_tolerance = 0.01;      // rad
constexpr double servo_position_tolerance = 0.004;  // m
constexpr std::chrono::seconds settling_timeout{2};

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
    robot().wait_for_next(last, std::min(left, longest_wait), context_.stop_request->token());
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
  for (auto waits = package_timeout / longest_wait; waits > 0; --waits) {
    if (auto why = stop_reason()) {
      return why;
    }
    publish_feedback_if_due();
    if (robot().wait_for_next(sample, longest_wait, context_.stop_request->token())) {
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

}  // namespace ur_ros_rtde
