#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/command_traits.hpp"
#include "ur_ros_rtde/detail/goal.hpp"
#include "ur_ros_rtde/detail/run_context.hpp"
#include "ur_ros_rtde/plugin_host.hpp"

namespace ur_ros_rtde {

/// The goals whose command is being executed. Thread-safe.
class Executions {
 public:
  /// Until the end of the returned object, which is that of the command.
  std::shared_ptr<void> begin(const Goal & goal)
  {
    const std::lock_guard lock(mutex_);
    goals_.insert(&goal);
    return {nullptr, [this, &goal](void *) {
              const std::lock_guard end(mutex_);
              goals_.erase(&goal);
            }};
  }
  /// Success if none of them was abandoned: its result has been sent, and the command has not returned.
  Status are_current(const std::string & action) const;

 private:
  mutable std::mutex mutex_;
  std::set<const Goal *> goals_;
};

/// How the goals of a command use the robot. The same for all of its goals.
struct CommandDescription {
  CommandHost & host;
  std::string plugin;  ///< "move_l"
  std::string action;  ///< resolved name: "/left/move_l"
  CommandTraits traits;
  bool is_extension = false;
  std::shared_ptr<Executions> executions = std::make_shared<Executions>();

  /// Its goals are served like stops.
  bool is_stop() const { return traits.preempts_all || traits.stops_arm; }
  /// The command stops the arm and does nothing else.
  bool only_stops() const { return traits.preempts_all && !traits.allowed_in_any_state; }
  /// A goal ends when the robot can no longer move.
  bool needs_motion() const
  {
    return moves_arm(traits.resource) && !traits.allowed_in_any_state && !traits.preempts_all;
  }
  bool stops_when_client_lost() const { return host.options().stop_when_client_lost && !is_stop(); }
};

/// A goal of a robot command: takes the robot, and leaves the arm at rest.
class CommandGoal : public Goal {
 public:
  CommandGoal(std::shared_ptr<const CommandDescription> command, const rcl_cxx::GoalUUID & id)
      : Goal(command->host, command->action, id), command_(std::move(command))
  {
  }

  Status check(std::vector<GoalQuery> & queries) final;
  void release() final;
  std::optional<Error> ended_by_robot() const final;
  std::optional<Status> stopped() const final;

 protected:
  /// Its poses have to be transformed by resolve() before they are checked.
  virtual bool has_frame(const std::string & base) const = 0;
  virtual Status resolve(Frames & frames, const std::stop_token & stop) = 0;
  virtual void check_fields(Check & check) const = 0;
  virtual StopOptions stop_options() const = 0;
  /// The field of the goal; empty if there is none: what its modes end with is not changed.
  virtual std::optional<bool> outlives_client() const = 0;
  /// The command itself. May throw.
  virtual Outcome run_command(const RunContext & context) = 0;

  Robot & robot() const { return command_->host.robot(); }

 private:
  Outcome execute() final;
  void on_stop(const Error & why) final;

  /// Once the poses are in `base`.
  Status check_in_base(std::vector<GoalQuery> & queries);
  Claim claim();
  bool preempts() const;
  Status prepare();
  void begin_stop();
  /// Since the goal was received, nothing has happened that it must not survive: a stop, or an end of the
  /// program that is not a consequence of its preemption.
  Status is_not_overtaken() const;
  /// No supervision has a reason against a goal that moves the arm, and no abandoned goal of this command is
  /// still being executed.
  Status may_execute() const;
  Outcome run_recorded();
  Status acquire();
  void hold(Lease lease);
  RunContext make_context();
  /// Names the lost connection or the ended program as the cause of a failure that results from it.
  Outcome explain(Outcome outcome, const Generation & begin) const;
  /// Stops what the goal has started and does not leave active.
  Outcome settle(const Outcome & outcome);
  /// Lets the modes that the goal leaves on end with its client, if it asks for that.
  Outcome leave_modes(const Outcome & outcome);
  /// Modes are active that were not before, or a call that may start one.
  bool started_modes() const;
  /// For a goal that shares the arm with others: something is active that it may have started and may not
  /// leave so.
  bool leaves_active(const Outcome & outcome) const;

  const std::shared_ptr<const CommandDescription> command_;
  // When the goal was received:
  std::uint32_t stops_before_ = 0;  ///< CommandHost::stops()
  bool program_may_begin_ = false;  ///< after the stop, by a request that was sent before
  Generation received_;
  std::optional<std::shared_future<Expected<StopReport>>> stopping_;  ///< of a stop
  std::string preempted_goal_;
  mutable std::mutex lease_mutex_;  ///< guards what follows
  Lease lease_;
  StopOptions stop_options_;  ///< of the command that runs: this one, or one that it calls
  /// Modes that previous goals have left active. Empty: the command has not begun.
  std::optional<Activities> active_before_;
  std::uint32_t mode_switches_ = 0;  ///< CommandHost::mode_switches() of that time
};

}  // namespace ur_ros_rtde
