#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>
#include <utility>

#include "ur_ros_rtde/detail/goal_book.hpp"
#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// What Command<A> and DashboardCommand<A> have in common: an action server whose goals are kept in a
/// GoalBook, each of them with a thread and exactly one result. `A`'s result begins `bool success, uint16
/// error_code, string message`.
template <typename A>
class GoalServer {
 protected:
  using Handle = rcl_cxx::GoalHandle<A>;

  GoalServer() = default;
  virtual ~GoalServer() = default;

  virtual tl::expected<void, std::string> admit(const rcl_cxx::GoalId & id,
                                                const typename A::Goal & goal) = 0;
  /// In the goal's own thread; ends with finish().
  virtual void carry_out(Handle & handle, GoalBook::Ticket & ticket) = 0;
  /// An accepted goal has got no thread; ends with finish().
  virtual void give_up(Handle & handle, const Outcome & outcome) = 0;
  /// Puts how the goal ended into its result; to be replaced for results that begin in another way.
  virtual void tell(const Outcome & outcome, typename A::Result & result) const
  {
    if constexpr (requires { result.success; }) {
      result.success = static_cast<bool>(outcome);
      result.error_code = static_cast<std::uint16_t>(outcome.code());
      result.message = outcome.message();
    }
  }

  /// `book` outlives the server. With `needs_client` a goal ends when the client that sent it disappears.
  void serve(rcl_cxx::Node & node, const std::string & name, GoalBook & book, bool needs_client);
  void end_service() { server_.reset(); }
  /// The goal's one result: tells in it how the goal ended, and sends it.
  void finish(Handle & handle, typename A::Result & result, const Outcome & outcome);

 private:
  /// tell(); what it throws is the outcome then.
  Outcome fill(const Outcome & outcome, typename A::Result & result) const;

  GoalBook * book_ = nullptr;
  typename rcl_cxx::ActionServer<A>::SharedPtr server_;
};

template <typename A>
void GoalServer<A>::serve(rcl_cxx::Node & node, const std::string & name, GoalBook & book, bool needs_client)
{
  book_ = &book;
  rcl_cxx::ActionHandlers<A> handlers;
  handlers.goal = [this](const rcl_cxx::GoalId & id, const typename A::Goal & goal) {
    return admit(id, goal);
  };
  handlers.accepted = [this](std::shared_ptr<Handle> handle) {
    const Status started = book_->start(
        handle->goal_id(),
        [this, handle](std::shared_ptr<GoalBook::Ticket> ticket) { carry_out(*handle, *ticket); });
    if (!started) {
      give_up(*handle, started);
    }
  };
  handlers.cancel = [](Handle &) { return true; };
  handlers.canceling = [this](Handle & handle) {
    book_->end(handle.goal_id(), Error{ErrorCode::canceled, "canceled by a client"});
  };
  handlers.discarded = [this](const rcl_cxx::GoalId & id) { book_->discard(id); };
  if (needs_client) {
    handlers.client_lost = [this](Handle & handle) { book_->end(handle.goal_id(), client_lost()); };
  }
  handlers.missing_result = [this](rcl_cxx::GoalStatus status, typename A::Result & result) {
    fill(missing_result(status), result);
  };
  server_ = node.template create_action_server<A>(name, std::move(handlers));
}

template <typename A>
Outcome GoalServer<A>::fill(const Outcome & outcome, typename A::Result & result) const
{
  bool told = false;
  const Outcome end = book_->guarded(Interrupt(), [&] {
    tell(outcome, result);
    told = true;
    return outcome;
  });
  if (!told) {
    GoalServer<A>::tell(end, result);
  }
  return end;
}

template <typename A>
void GoalServer<A>::finish(Handle & handle, typename A::Result & result, const Outcome & outcome)
{
  const Outcome end = fill(outcome, result);
  book_->finish(handle.goal_id(), end);
  if (end) {
    handle.succeed(result);
  } else if (end.code() == ErrorCode::canceled && handle.is_canceling()) {
    handle.canceled(result);
  } else {
    handle.abort(result);
  }
}

}  // namespace ur_ros_rtde
