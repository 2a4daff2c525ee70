#include "ur_ros_rtde/tool_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {

/// The distance (m) or the angle (rad) between two poses, whichever is greater.
double pose_difference(const std::vector<double> & a, const std::vector<double> & b)
{
  Vector6 first;
  Vector6 second;
  std::copy_n(a.begin(), 6, first.begin());
  std::copy_n(b.begin(), 6, second.begin());
  const Vector6 offset = pose_trans(pose_inverse(first), second);
  return std::max(length(position(offset)), length(rotation(offset)));
}

Sample with_payload(const Sample & sample)
{
  if (std::isnan(sample.payload)) {
    throw RobotError({ErrorCode::not_supported,
                      "this controller does not report its payload (PolyScope 5.5 and later do), which could "
                      "not be put back"});
  }
  return sample;
}

/// It moves the arm as it is told with the present payload and TCP.
void require_no_force_mode(const Robot & robot)
{
  if (robot.activities().contains(Activity::force_mode)) {
    throw RobotError({ErrorCode::busy, "force mode is on: end it, then set it again"});
  }
}

/// The load of a moving arm is not changed: stops what the goal has started. If a stop has taken the arm out
/// of its hands, waits for the end of the stop.
void require_standstill(Run & run)
{
  constexpr std::chrono::seconds limit{5};
  constexpr std::chrono::milliseconds timeout{100};
  const Robot & robot = run.robot();
  if (run.may_brake()) {  // it has the arm
    if (const Outcome stopped = run.stop_motion(); !stopped) {
      throw RobotError(stopped.error());
    }
  }
  const auto deadline = std::chrono::steady_clock::now() + limit;
  const auto is_busy = [&] { return robot.is_moving() || robot.is_stopping(); };
  for (Sample sample{}; is_busy() && std::chrono::steady_clock::now() < deadline;) {
    static_cast<void>(robot.wait_for_next(sample, timeout));
  }
  if (robot.is_moving()) {
    throw RobotError({ErrorCode::busy, "the arm moves: set it again when it is at rest"});
  }
  require_no_force_mode(robot);
}

}  // namespace

Outcome set_payload(Run & run, double mass, const Vector3 & center_of_gravity)
{
  check_result(run.control()->setPayload(mass, to_ur_center_of_gravity(center_of_gravity)),
               "set the payload");
  return run.expect([&] { return has_payload(run.state(), mass, center_of_gravity); }, setting_timeout,
                    "the robot still reports another payload");
}

bool has_payload(const Sample & sample, double mass, const Vector3 & center_of_gravity)
{
  constexpr double tolerance = 1e-3;  // kg, m
  const Vector3 & reported = sample.payload_cog;
  const Vector3 & expected = center_of_gravity;
  return std::isnan(sample.payload) || (std::abs(sample.payload - mass) < tolerance &&
                                        length(reported[0] - expected[0], reported[1] - expected[1],
                                               reported[2] - expected[2]) < tolerance);
}

std::vector<double> to_ur_center_of_gravity(const Vector3 & center_of_gravity)
{
  const bool zero = center_of_gravity == Vector3{};
  return {center_of_gravity[0], center_of_gravity[1], zero ? 1e-9 : center_of_gravity[2]};
}

Outcome set_tcp(Run & run, const std::vector<double> & offset)
{
  constexpr double tolerance = 1e-5;  // m, rad
  if (offset.size() != 6) {
    throw RobotError(
        {ErrorCode::invalid_goal, fmt::format("a TCP has 6 values (m, rad), not {}", offset.size())});
  }
  check_result(run.control()->setTcp(offset), "set the TCP");
  return run.expect([&] { return pose_difference(run.control()->getTCPOffset(), offset) < tolerance; },
                    setting_timeout, "the robot still reports another TCP");
}

/// The other constructor has completed the object: its destructor runs if `set` throws or fails.
TemporarySetting::TemporarySetting(Run & run, std::string name, const std::function<Outcome()> & set,
                                   PutBack put_back)
    : TemporarySetting(run, std::move(name), std::move(put_back))
{
  if (const Outcome outcome = set(); !outcome) {
    throw RobotError(outcome.error());
  }
}

/// The goal may have lost the right to move the arm, which this does not need.
TemporarySetting::~TemporarySetting()
{
  if (!put_back_) {
    return;
  }
  try {
    require_standstill(run_);
    check_result(put_back_(*run_.control_for_queries().hold()), "accept it");
  } catch (const std::exception & error) {
    run_.warn(fmt::format("{} was not put back: {}", name_, error.what()));
  }
}

TemporarySetting temporary_payload(Run & run, double mass, const Vector3 & center_of_gravity)
{
  require_no_force_mode(run.robot());
  const Sample before = with_payload(run.state());
  return {run, "the payload", [&] { return set_payload(run, mass, center_of_gravity); },
          [before](ur_rtde::RTDEControlInterface & control) {
            return control.setPayload(before.payload, to_ur_center_of_gravity(before.payload_cog));
          }};
}

TemporarySetting temporary_tcp(Run & run, const std::vector<double> & offset)
{
  require_no_force_mode(run.robot());
  const std::vector<double> before = run.control()->getTCPOffset();
  return {run, "the TCP", [&] { return set_tcp(run, offset); },
          [before](ur_rtde::RTDEControlInterface & control) { return control.setTcp(before); }};
}

}  // namespace ur_ros_rtde
