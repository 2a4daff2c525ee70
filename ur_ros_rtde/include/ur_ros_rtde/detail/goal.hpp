#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <rcl_cxx/goal_uuid.hpp>
#include <rcl_cxx/server_goal_handle.hpp>
#include <string>
#include <vector>

#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

class PluginHost;

/// A check of a goal that waits for an answer of the robot.
using GoalQuery = std::function<Status()>;

/// One goal, from its request to its only result. It owns everything that belongs to it alone: the request to
/// stop it, what a derived class adds (a lease), and the result. docs/internals/goals.md shows its life.
class Goal : public std::enable_shared_from_this<Goal> {
 public:
  using Handle = rcl_cxx::ServerGoalHandle;

  /// `action`: resolved name of the action. `host` outlives the goal.
  Goal(PluginHost & host, std::string action, const rcl_cxx::GoalUUID & id);
  virtual ~Goal() = default;
  Goal(const Goal &) = delete;
  Goal & operator=(const Goal &) = delete;

  const std::string & action() const { return action_; }
  const rcl_cxx::GoalUUID & id() const { return id_; }
  /// "/move_j 3f0c12ab", for messages.
  std::string name() const;
  const StopRequest & stop_request() const { return *stop_request_; }

  // In the order of its life:

  /// Success if the goal can be accepted, once `queries` have succeeded in a thread of their own. Runs in the
  /// thread that serves the request, and must not wait. May throw.
  virtual Status check(std::vector<GoalQuery> & queries) = 0;
  /// Gives back what the goal holds (a lease). Called when it is not executed: it was rejected, or its client
  /// has not received the acceptance; and before the result is sent, so that the client's next goal finds
  /// nothing in its way. May be called more than once, by any thread.
  virtual void release() {}
  /// The goal was accepted: `handle` is to get a result.
  void accept(std::shared_ptr<Handle> handle);
  /// Executes the goal and sends its result, in the goal's thread.
  void run();
  /// Tells the goal to end because of `why`. Returns at once; may be called by any thread, at any time.
  void stop(const Error & why);
  /// Why the robot does not let the goal go on. Its command may not look: Goals then tells the goal to end.
  virtual std::optional<Error> ended_by_robot() const { return std::nullopt; }
  /// The outcome of stopping what moves the arm, if the goal was told to end. Empty while it is being
  /// stopped.
  virtual std::optional<Status> stopped() const { return Status(); }
  /// Sends the result without the goal's thread, which has not ended in time after stop().
  void abandon();
  /// Sends the result of a goal that is not executed.
  void end(const Outcome & outcome);
  bool is_finished() const { return finished_; }

 protected:
  /// Executes the goal. Runs in the goal's thread; may throw.
  virtual Outcome execute() = 0;
  /// Called by stop() for a goal that was accepted: once, and again for a shutdown.
  virtual void on_stop(const Error &) {}
  /// Writes `outcome` into the result and sends it with send(). `abandoned`: execute() still runs.
  virtual void send_result(const Outcome & outcome, bool abandoned) = 0;

  PluginHost & host() const { return host_; }
  const std::shared_ptr<StopRequest> & shared_stop_request() const { return stop_request_; }
  Handle & handle() const { return *handle_; }
  const std::shared_ptr<Handle> & shared_handle() const { return handle_; }
  /// `result`: an A::Result of the action.
  void send(const Outcome & outcome, const void * result);
  void warn(const std::string & text) const;

 private:
  void finish(const Outcome & outcome, bool abandoned);
  void log(const Outcome & outcome) const;

  PluginHost & host_;
  const std::string action_;
  const rcl_cxx::GoalUUID id_;
  const std::shared_ptr<StopRequest> stop_request_ = std::make_shared<StopRequest>();
  std::shared_ptr<Handle> handle_;
  std::mutex mutex_;  ///< stop() against accept()
  bool accepted_ = false;
  std::atomic<bool> finished_ = false;
};

/// "speed is 9 (invalid_goal 1)"
std::string with_code(const Error & error);

/// Writes the outcome into `bool success, uint16 error_code, string message`, if the result begins with them.
template <typename Result>
void write_standard_fields(const Outcome & outcome, Result & result)
{
  if constexpr (requires { result.success; }) {
    result.success = static_cast<bool>(outcome);
    result.error_code = static_cast<std::uint16_t>(outcome.code());
    result.message = outcome.message();
  }
}

}  // namespace ur_ros_rtde
