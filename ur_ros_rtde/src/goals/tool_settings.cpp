#include "ur_ros_rtde/tool_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {

/// How long it may take until the state of the robot contains a new setting.
constexpr std::chrono::seconds setting_timeout{1};

/// The distance (m) or the angle (rad) between two poses, whichever is greater.
double pose_difference(const std::vector<double> & a, const std::vector<double> & b)
{
  Vector6 first;
  Vector6 second;
  std::copy_n(a.begin(), 6, first.begin());
  std::copy_n(b.begin(), 6, second.begin());
  const Vector6 offset = pose_trans(pose_inverse(first), second);
  return std::max(std::hypot(offset[0], offset[1], offset[2]), std::hypot(offset[3], offset[4], offset[5]));
}

void throw_if_failed(const Outcome & outcome)
{
  if (!outcome) {
    throw RobotError(outcome.error());
  }
}

double known_payload(const Sample & sample)
{
  if (std::isnan(sample.payload)) {
    throw RobotError({ErrorCode::not_supported,
                      "this controller does not report its payload (PolyScope 5.5 and later do), which could "
                      "not be put back"});
  }
  return sample.payload;
}

/// Waits for the end of a motion or of a stop. The load of a moving arm is not changed.
void wait_for_standstill(const Robot & robot)
{
  constexpr std::chrono::seconds limit{5};
  constexpr std::chrono::milliseconds timeout{100};
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (Sample sample{}; robot.is_moving() && std::chrono::steady_clock::now() < deadline;) {
    static_cast<void>(robot.wait_for_next(sample, timeout));
  }
}

/// Puts a setting back in a destructor. The goal may have lost the right to move the arm, which this needs
/// not.
template <class Set>
void put_back(Run & run, const char * what, const Set & set)
{
  try {
    wait_for_standstill(run.robot());
    check_result(set(*run.control_for_queries().hold()), "accept it");
  } catch (const std::exception & error) {
    run.warn(fmt::format("{} was not put back: {}", what, error.what()));
  }
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
                                        std::hypot(reported[0] - expected[0], reported[1] - expected[1],
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
  check_result(run.control()->setTcp(offset), "set the TCP");
  return run.expect([&] { return pose_difference(run.control()->getTCPOffset(), offset) < tolerance; },
                    setting_timeout, "the robot still reports another TCP");
}

TemporaryPayload::TemporaryPayload(Run & run, double mass, const Vector3 & center_of_gravity)
    : run_(run), mass_before_(known_payload(run.state())), center_of_gravity_before_(run.state().payload_cog)
{
  throw_if_failed(set_payload(run, mass, center_of_gravity));
}

TemporaryPayload::~TemporaryPayload()
{
  if (keeps_) {
    return;
  }
  put_back(run_, "the payload", [this](ur_rtde::RTDEControlInterface & control) {
    return control.setPayload(mass_before_, to_ur_center_of_gravity(center_of_gravity_before_));
  });
}

TemporaryTcp::TemporaryTcp(Run & run, const std::vector<double> & offset)
    : run_(run), before_(run.control()->getTCPOffset())
{
  throw_if_failed(set_tcp(run, offset));
}

TemporaryTcp::~TemporaryTcp()
{
  if (keeps_) {
    return;
  }
  put_back(run_, "the TCP",
           [this](ur_rtde::RTDEControlInterface & control) { return control.setTcp(before_); });
}

}  // namespace ur_ros_rtde
