#include "robotiq/robotiq_gripper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ur_ros_rtde_gripper_commands {
namespace {

using ur_ros_rtde::ErrorCode;
using ur_ros_rtde::Outcome;
using ur_ros_rtde::RobotError;

/// The fingers have stopped if two states at this interval are equal. It is longer than the cycle in which
/// the URCap reads the gripper, so that a state from before the motion does not count.
constexpr std::chrono::milliseconds poll_interval{30};
/// From the request of a motion to the registers that show it; generously.
constexpr std::chrono::milliseconds longest_reaction{300};
constexpr int position_tolerance = 3;  ///< of register POS at the target
constexpr int action_delayed_fault = 5;
constexpr int activation_required_fault = 7;

RobotiqClient connect(const std::string & address)
{
  auto client = RobotiqClient::connect(address);
  if (!client) {
    throw RobotError(client.error());
  }
  return std::move(*client);
}

/// Faults that end with the next activation or motion.
bool is_pending_action(int fault)
{
  return fault == action_delayed_fault || fault == activation_required_fault;
}

}  // namespace

std::string robotiq_fault_text(int fault)
{
  switch (fault) {
    case 0:
      return "";
    case action_delayed_fault:
      return "the activation must be completed first: wait for it";
    case activation_required_fault:
      return "the gripper is not activated: send robotiq_activate";
    case 8:
      return "the gripper is too hot: let it cool down, and reduce force and frequency of the motions";
    case 9:
      return "the gripper gets no messages: check its cable and the settings of the URCap";
    case 10:
      return "the supply voltage is too low: check the cable and the 24 V supply, then send robotiq_activate "
             "with reset";
    case 11:
      return "an automatic release is in progress: wait for it, then send robotiq_activate with reset";
    case 12:
      return "internal fault: send robotiq_activate with reset; contact Robotiq if it remains";
    case 13:
      return "the activation failed: remove what blocks the fingers, then send robotiq_activate with reset";
    case 14:
      return "overcurrent: remove what blocks the fingers, then send robotiq_activate with reset";
    case 15:
      return "an automatic release is completed: send robotiq_activate with reset";
    default:
      return "unknown fault code: see the manual of the gripper";
  }
}

double FingerRange::width(int position) const
{
  return stroke * (1.0 - static_cast<double>(std::min(position, closed_position)) / closed_position);
}

int FingerRange::position(double width) const
{
  return std::clamp(static_cast<int>(std::lround(closed_position * (1.0 - width / stroke))), 0,
                    closed_position);
}

RobotiqGripper::RobotiqGripper(ur_ros_rtde::Run & run, double timeout, Observer observe)
    : run_(run),
      deadline_(std::chrono::steady_clock::now() +
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                    std::chrono::duration<double>(timeout))),
      observe_(std::move(observe)),
      client_(connect(run.robot().address()))
{
}

int RobotiqGripper::get(std::string_view name)
{
  const auto value = client_.get(name);
  if (!value) {
    throw RobotError(value.error());
  }
  return *value;
}

void RobotiqGripper::set(const std::string & assignments)
{
  if (run_.is_abandoned()) {
    throw RobotError(run_.stop_reason().value());  // while the URCap did not answer
  }
  if (const auto done = client_.set(assignments); !done) {
    throw RobotError(done.error());
  }
}

RobotiqState RobotiqGripper::read()
{
  return {.status = get("STA"),
          .contact = get("OBJ"),
          .fault = get("FLT"),
          .position = get("POS"),
          .go_to = get("GTO")};
}

Outcome RobotiqGripper::until(const Condition & condition, const std::string & otherwise)
{
  while (true) {
    const RobotiqState state = read();
    observe_(state);
    if (state.fault != 0 && !is_pending_action(state.fault)) {
      return Outcome::failure(
          ErrorCode::rejected_by_robot,
          fmt::format("fault {} of the gripper: {}", state.fault, robotiq_fault_text(state.fault)));
    }
    if (condition(state)) {
      return Outcome::success();
    }
    if (std::chrono::steady_clock::now() >= deadline_) {
      return Outcome::failure(ErrorCode::timeout, otherwise);
    }
    if (auto reason = run_.sleep_for(poll_interval)) {
      return *reason;
    }
  }
}

Outcome RobotiqGripper::activate(bool reset)
{
  const RobotiqState before = read();
  if (!reset && before.active() && before.fault == 0) {
    observe_(before);
    return Outcome::success("the gripper was active already");
  }
  const auto body = [this] {
    const Outcome cleared = clear();
    return cleared ? start_activation() : cleared;
  };
  // Without its activation, the gripper does not move.
  return stop_unless_successful(body, "GTO 0 ACT 0");
}

/// Resets the gripper and waits until it has no fault that prevents the activation.
Outcome RobotiqGripper::clear()
{
  set("GTO 0 ACT 0 ATR 0");
  RobotiqState state = read();
  const auto has_fault = [&state] { return state.fault != 0 && !is_pending_action(state.fault); };
  while (state.status != 0 || has_fault()) {
    if (const bool late = std::chrono::steady_clock::now() >= deadline_; late && has_fault()) {
      return Outcome::failure(ErrorCode::timeout, fmt::format("the gripper does not leave fault {}: {}",
                                                              state.fault, robotiq_fault_text(state.fault)));
    } else if (late) {
      return Outcome::failure(ErrorCode::timeout,
                              "the gripper does not reset: check its cable and the URCap");
    }
    if (auto reason = run_.sleep_for(poll_interval)) {
      return *reason;
    }
    state = read();
  }
  return Outcome::success();
}

Outcome RobotiqGripper::start_activation()
{
  set("ACT 1");
  return until(
      [](const RobotiqState & state) { return state.active(); },
      "the activation of the gripper takes longer than timeout: check that the fingers can close and "
      "open completely");
}

Outcome RobotiqGripper::move(const RobotiqTarget & target)
{
  if (const RobotiqState before = read(); !before.active()) {
    return Outcome::failure(
        ErrorCode::not_ready,
        "the gripper is not active: send robotiq_activate, which closes and opens the fingers");
  }
  const auto body = [&] {
    const Outcome started = start_motion(target);
    return started ? until_stopped(target.position) : started;
  };
  return stop_unless_successful(body, "GTO 0");
}

/// The gripper moves only after it has confirmed the target (register PRE), as in the functions of the URCap.
Outcome RobotiqGripper::start_motion(const RobotiqTarget & target)
{
  set(fmt::format("GTO 0 POS {} SPE {} FOR {}", target.position, target.speed, target.force));
  Outcome outcome =
      until([&](const RobotiqState &) { return get("PRE") == target.position; },
            "the gripper does not confirm the target: check its cable and the settings of the URCap");
  if (auto reason = run_.stop_reason(); reason && outcome) {
    outcome = *std::move(reason);  // while the gripper answered
  }
  if (outcome) {
    set("GTO 1");
  }
  return outcome;
}

/// OBJ is that of the motion before until the gripper has reacted.
Outcome RobotiqGripper::until_stopped(int target)
{
  std::optional<RobotiqState> last;
  bool has_moved = false;
  const auto reacted = std::chrono::steady_clock::now() + longest_reaction;
  const auto stopped = [&](const RobotiqState & state) {
    if (!state.active()) {
      throw RobotError(
          {ErrorCode::rejected_by_robot, "the gripper was deactivated: another client of the URCap uses it"});
    }
    has_moved = has_moved || state.contact == 0;
    const bool is_new = has_moved || std::abs(state.position - target) <= position_tolerance ||
                        std::chrono::steady_clock::now() >= reacted;
    const bool rests = state.go_to == 1 && state.contact != 0 && state == last;
    last = state;
    return rests && is_new;
  };
  return until(stopped, "the fingers are still moving after timeout: increase timeout or speed_fraction");
}

/// Stops the fingers with `registers` if the body fails or throws. Returns its outcome, with a warning if the
/// fingers may still move.
Outcome RobotiqGripper::stop_unless_successful(const std::function<Outcome()> & body,
                                               const std::string & registers)
{
  Outcome outcome = Outcome::success();
  try {
    outcome = body();
  } catch (const RobotError & error) {
    outcome = error.error();
  }
  if (outcome) {
    return outcome;
  }
  if (run_.is_abandoned() && run_.robot().holder(ur_ros_rtde::Resource::io)) {
    return outcome;  // the gripper may be that of another goal
  }
  const auto stopped = client_.set(registers);
  return stopped ? outcome
                 : Outcome::failure(outcome.code(), fmt::format("{}; the fingers may still move: {}",
                                                                outcome.message(), stopped.error().message));
}

}  // namespace ur_ros_rtde_gripper_commands
