#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <rcl_cxx/goal_id.hpp>
#include <string>
#include <tl/expected.hpp>

#include "ur_ros_rtde_robot/motion/arbiter.hpp"
#include "ur_ros_rtde/detail/interrupt.hpp"
#include "ur_ros_rtde/plugin_host.hpp"

namespace ur_ros_rtde {

/// Why a goal ends whose client has disappeared.
Interruption client_lost();

/// How a goal ended that has no result, or none that can be sent: never without an error code.
Outcome missing_result(rcl_cxx::GoalStatus status);

/// The goals of one action, independent of its type: admission, threads, requests to end, end. Thread-safe.
class GoalBook {
 public:
  struct Ticket : std::enable_shared_from_this<Ticket> {
    std::shared_ptr<Interrupt> interrupt = std::make_shared<Interrupt>();
    std::string displaced;  ///< the goal that had to end for this one

    /// Keeps the lease until finish(), or until the goal is asked to end before it has started.
    void hold(Lease lease);
    bool holds() const;
    /// Asks the goal to end. One that has not started frees what it holds at once.
    void end(Interruption why);

   private:
    friend class GoalBook;
    mutable std::mutex mutex_;
    Lease lease_;
    bool started_ = false;
  };

  /// `action` is the resolved name.
  GoalBook(PluginHost & host, std::string action) : host_(host), action_(std::move(action)) {}
  GoalBook(const GoalBook &) = delete;
  GoalBook & operator=(const GoalBook &) = delete;

  const std::string & action() const { return action_; }

  /// Whether the goal may be accepted: `examine` decides. A refusal is published, and returned for the log.
  tl::expected<void, std::string> admit(const rcl_cxx::GoalId & id,
                                        const std::function<Status(Ticket &)> & examine);
  /// Runs `work`, which must not throw, for an admitted goal in a thread of its own.
  Status start(const rcl_cxx::GoalId & id, std::function<void(std::shared_ptr<Ticket>)> work);
  /// Asks a goal to end, if there is one of this id.
  void end(const rcl_cxx::GoalId & id, const Interruption & why);
  /// Forgets an admitted goal that will not be accepted, and frees what it holds.
  void discard(const rcl_cxx::GoalId & id);
  /// Before the result is sent: what was held is free, the goal is forgotten, and its end logged.
  void finish(const rcl_cxx::GoalId & id, const Outcome & outcome);
  void warn(const rcl_cxx::GoalId & id, const std::string & text) const;
  /// `body`'s outcome, or what it threw as one; if the goal was to end, that is the outcome of a failure.
  Outcome guarded(const Interrupt & interrupt, const std::function<Outcome()> & body) const;

 private:
  std::shared_ptr<Ticket> find(const rcl_cxx::GoalId & id) const;

  PluginHost & host_;
  const std::string action_;
  mutable std::mutex mutex_;
  std::map<rcl_cxx::GoalId, std::shared_ptr<Ticket>> tickets_;
};

}  // namespace ur_ros_rtde
