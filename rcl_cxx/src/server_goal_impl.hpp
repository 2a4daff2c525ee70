#pragma once

#include <rcl_action/goal_handle.h>
#include <rmw/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "client_watch.hpp"
#include "rcl_cxx/goal_uuid.hpp"
#include "rcl_cxx/server_goal_handle.hpp"

namespace rcl_cxx::detail {
class ActionServerImpl;

/// A goal as the server keeps it, from its acceptance until its result expires. GoalHandles share it.
class ServerGoalImpl {
 public:
  /// Takes over the state that rcl_action_accept_new_goal has made: rcl keeps a list of such structs, but
  /// frees nothing that they point to.
  ServerGoalImpl(std::weak_ptr<ActionServerImpl> server, GoalUUID id,
                 const rcl_action_goal_handle_t & handle);
  ~ServerGoalImpl();
  ServerGoalImpl(const ServerGoalImpl &) = delete;
  ServerGoalImpl & operator=(const ServerGoalImpl &) = delete;

  const GoalUUID & id() const noexcept { return id_; }
  std::int64_t accepted_ns() const noexcept { return accepted_ns_; }
  /// Readable without the server's lock.
  GoalStatus get_status() const noexcept { return status_.load(); }
  std::shared_ptr<ActionServerImpl> server() const noexcept { return server_.lock(); }

  /// Its result has been sent to someone.
  std::atomic<bool> result_sent{false};

  // --- the rest only under the server's lock ---

  /// False if the state machine has no such transition now.
  bool update(rcl_action_goal_event_t event);
  /// The server is gone: nothing can be done with the goal any more.
  void orphan() noexcept { status_ = GoalStatus::aborted; }

  std::weak_ptr<ServerGoalHandleBase> handle;     // the user's
  bool cancel_being_decided = false;              // its cancel handler runs
  std::shared_ptr<void> result_response;          // set with a terminal state
  std::vector<rmw_request_id_t> result_requests;  // to be answered with it
  std::chrono::steady_clock::time_point ended{};
  std::optional<ClientWatch> client;  // while it is watched

 private:
  const std::weak_ptr<ActionServerImpl> server_;
  const GoalUUID id_;
  rcl_action_goal_handle_t rcl_handle_;
  std::int64_t accepted_ns_ = 0;
  std::atomic<GoalStatus> status_{GoalStatus::accepted};
};

}  // namespace rcl_cxx::detail
