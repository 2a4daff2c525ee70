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
constexpr std::chrono::hours max_motion_duration{24};
constexpr std::chrono::minutes longest_idle_motion{10};
/// For motions whose end the controller does not report: they end where the arm comes to rest.
constexpr double servo_joint_tolerance = 0.01;      // rad
constexpr double servo_position_tolerance = 0.004;  // m
constexpr std::chrono::seconds settling_timeout{2};

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

/// By the speed slider.
bool is_paused(const Sample & sample)
{
  constexpr double least_fraction = 0.01;
  return sample.target_speed_fraction < least_fraction;
}

/// Measures how long the arm has not come closer to its target.
class Approach {
 public:
  explicit Approach(double distance) : nearest_(distance) {}
  void update(double distance, bool may_be_idle)
  {
    constexpr double least_step = 1e-4;  // rad, m
    const bool comes_closer = distance < nearest_ - least_step;
    nearest_ = comes_closer ? distance : nearest_;
    last_ = comes_closer || may_be_idle ? Clock::now() : last_;
  }
  Clock::duration idle() const { return Clock::now() - last_; }

 private:
  double nearest_;
  Clock::time_point last_ = Clock::now();
};
}  // namespace

/// Where a motion has to end.
struct Run::Target {
  std::function<double(const Sample &)> distance;          ///< rad or m
  std::function<std::string(const Sample &)> description;  ///< of the distance

  static Target joints(const std::vector<double> & positions);
  static Target pose(const std::vector<double> & pose);
  static Target position(const std::vector<double> & pose);
  Outcome missed(const Sample & sample) const
  {
    return Outcome::failure(ErrorCode::not_reached,
                            fmt::format("the arm stopped {} before the target", description(sample)));
  }
};

/// The largest difference of all joints.
Run::Target Run::Target::joints(const std::vector<double> & positions)
{
  const auto distance = [target = to_array(positions)](const Sample & sample) {
    double largest = 0.0;
    for (std::size_t i = 0; i < target.size(); ++i) {
      largest = std::max(largest, std::abs(target[i] - sample.actual_q[i]));
    }
    return largest;
  };
  return {distance,
          [distance](const Sample & sample) { return fmt::format("{:.4f} rad", distance(sample)); }};
}

/// The distance of the positions, with the rotation weighted by rotation_weight.
Run::Target Run::Target::pose(const std::vector<double> & pose)
{
  const auto offset = [target = to_array(pose)](const Sample & sample) {
    const Vector6 d = pose_trans(pose_inverse(sample.actual_tcp_pose), target);
    return std::pair{length(ur_ros_rtde::position(d)), length(rotation(d))};
  };
  return {[offset](const Sample & sample) {
            const auto [distance, angle] = offset(sample);
            return distance + rotation_weight * angle;
          },
          [offset](const Sample & sample) {
            const auto [distance, angle] = offset(sample);
            return fmt::format("{:.4f} m and {:.4f} rad", distance, angle);
          }};
}

Run::Target Run::Target::position(const std::vector<double> & pose)
{
  const auto distance = [target = to_array(pose)](const Sample & sample) {
    const Vector6 & here = sample.actual_tcp_pose;
    return length(here[0] - target[0], here[1] - target[1], here[2] - target[2]);
  };
  return {distance, [distance](const Sample & sample) { return fmt::format("{:.4f} m", distance(sample)); }};
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
  auto why = until([this] { return robot().motion_progress(motion().mark).at_rest; }, timeout);
  if (why && why->code == ErrorCode::timeout) {
    why->message = "the arm did not come to a standstill: " + why->message;
  }
  return why;
}

bool Run::is_compliant() const
{
  const Activities active = robot().activities();
  return active.contains(Activity::force_mode) && !active.contains(Activity::contact_detection);
}

bool Run::motion_ended() const
{
  const MotionProgress progress = robot().motion_progress(motion().mark);
  return progress.finished() || (progress.ended() && is_compliant()) ||
         (!progress.started && Clock::now() - call_.begin > motion_start_timeout);
}

Outcome Run::until_motion_ends(std::chrono::nanoseconds timeout)
{
  if (auto why = until([this] { return motion_ended(); }, timeout)) {
    if (why->code == ErrorCode::timeout) {
      why->message = "the motion has not ended: " + why->message;
    }
    return *why;
  }
  if (!robot().motion_progress(motion().mark).started) {
    return Outcome::failure(ErrorCode::rejected_by_robot,
                            "the control program did not start the motion: see the log on the teach pendant");
  }
  return Outcome::success();
}

Outcome Run::until_reached(const Target & target, double tolerance)
{
  const double initial = target.distance(state());
  Approach approach(initial);
  bool ended = false;
  const auto update = [&] {
    const double left = target.distance(state());
    progress(initial > tolerance ? std::clamp(1.0 - left / initial, 0.0, 1.0) : 1.0);
    approach.update(left, is_paused(state()));
    ended = motion_ended();
    return ended || approach.idle() > longest_idle_motion;
  };
  if (auto why = until(update, max_motion_duration)) {
    return *why;
  }
  if (!ended) {
    return Outcome::failure(
        ErrorCode::timeout,
        fmt::format("the arm has not come closer to the target for {} min, {} are left: see the log on the "
                    "teach pendant",
                    longest_idle_motion.count(), target.description(state())));
  }
  const bool is_reached = target.distance(state()) <= tolerance;
  if (Outcome outcome = until_motion_ends(); !outcome && !is_reached) {
    return outcome;
  }
  if (!is_reached && !is_compliant()) {
    return target.missed(state());
  }
  progress(1.0);
  return Outcome::success();
}

Outcome Run::until_joints_reached(const std::vector<double> & positions)
{
  return until_reached(Target::joints(positions), joint_tolerance);
}

Outcome Run::until_pose_reached(const std::vector<double> & pose)
{
  return until_reached(Target::pose(pose), position_tolerance);
}

Outcome Run::until_at(const Target & target, double tolerance)
{
  const double initial = std::max(target.distance(state()), tolerance);
  Approach approach(initial);
  bool reached = false;
  const auto update = [&] {
    const double left = target.distance(state());
    progress(std::max(progress(), std::clamp(1.0 - left / initial, 0.0, 1.0)));
    const bool at_rest = robot().motion_progress(motion().mark).at_rest;
    approach.update(left, (!at_rest && !is_compliant()) || is_paused(state()));
    reached = at_rest && left <= tolerance;
    return reached || approach.idle() > settling_timeout || (is_compliant() && left <= tolerance);
  };
  if (auto why = until(update, max_motion_duration)) {
    return *why;
  }
  if (!reached && !is_compliant()) {
    return target.missed(state());
  }
  progress(1.0);
  return Outcome::success();
}

Outcome Run::until_at_rest_at_joints(const std::vector<double> & positions)
{
  return until_at(Target::joints(positions), servo_joint_tolerance);
}

Outcome Run::until_at_rest_at_pose(const std::vector<double> & pose)
{
  return until_at(Target::pose(pose), servo_position_tolerance);
}

Outcome Run::until_at_rest_at_position(const std::vector<double> & pose)
{
  return until_at(Target::position(pose), servo_position_tolerance);
}

}  // namespace ur_ros_rtde
