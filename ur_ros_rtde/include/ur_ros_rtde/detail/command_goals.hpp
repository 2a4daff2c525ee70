#pragma once

#include <functional>
#include <memory>
#include <rcl_cxx/goal_id.hpp>
#include <string>
#include <tl/expected.hpp>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/detail/goal_book.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// What a command needs, for all of its goals.
struct CommandTraits {
  Resource resource = Resource::motion;
  /// Is never refused for being busy: whoever is in the way has to end. Needs the link only.
  bool takes_over = false;
  /// A new goal ends the one of the same action that runs.
  bool replaces_its_own = false;
  /// Switches a mode on or off that lasts beyond the goal: success leaves the arm as it is.
  bool switches_mode = false;
  /// Is accepted, and goes on, whatever the robot's state: only its dashboard server has to be there.
  bool any_state = false;
  /// Of the plugin, if it is an extension: what the control program has to have.
  std::string extension;
};

/// The part of Command<A> that is compiled once: the goals of a command, their arbitration, and the
/// standstill at their end.
class CommandGoals {
 public:
  CommandGoals(CommandHost & host, std::string action, CommandTraits traits);

  CommandHost & host() { return host_; }
  GoalBook & book() { return book_; }
  /// The goal ends when the robot cannot move any more.
  bool needs_motion() const { return moves() && !traits_.any_state; }
  /// The goal ends when its client disappears. A stop does not.
  bool needs_client() const { return host_.options().stop_when_client_lost && !traits_.takes_over; }
  bool moves() const { return traits_.resource == Resource::motion || traits_.resource == Resource::script; }

  tl::expected<void, std::string> admit(const rcl_cxx::GoalId & id,
                                        const std::function<void(Check &)> & check);
  /// Gets what the command needs, runs `body`, and brings the arm to a standstill if `body` has not. `body`
  /// and `stop_options` may throw; without stop options nothing is run, and the default ones count.
  Outcome carry_out(const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket,
                    const std::function<StopOptions()> & stop_options, const std::function<Outcome()> & body);

 private:
  class RobotPreflight;

  Claim claim(const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket) const;
  Status readiness() const;
  /// Whoever is in the way will be asked to end when the goal begins.
  bool preempts() const;
  Status take(const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket, const StopOptions & stop);
  Outcome settle(Outcome outcome, const GoalBook::Ticket & ticket, StopOptions stop);

  CommandHost & host_;
  const CommandTraits traits_;
  GoalBook book_;
};

}  // namespace ur_ros_rtde
