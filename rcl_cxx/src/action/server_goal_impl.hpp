#pragma once

#include <rcl_action/goal_handle.h>
#include <rmw/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "action/client_watch.hpp"
#include "rcl_cxx/goal_uuid.hpp"
#include "rcl_cxx/server_goal_handle.hpp"

namespace rcl_cxx::detail {
class ActionServerImpl;

/// A goal of an action server, from its acceptance until its result expires. Shared with the
/// ServerGoalHandle.
class ServerGoalImpl {
 public:
  /// Copies the handle of rcl_action_accept_new_goal and takes over what it points to: rcl_action frees the
  /// handle itself, but not its contents.
  ServerGoalImpl(std::weak_ptr<ActionServerImpl> server, GoalUUID id,
                 const rcl_action_goal_handle_t & handle);
  ~ServerGoalImpl();
  ServerGoalImpl(const ServerGoalImpl &) = delete;
  ServerGoalImpl & operator=(const ServerGoalImpl &) = delete;

  const GoalUUID & id() const noexcept { return id_; }
  std::int64_t get_goal_stamp() const noexcept { return stamp_; }
  GoalStatus get_status() const noexcept { return status_.load(); }
  std::shared_ptr<ActionServerImpl> server() const noexcept { return server_.lock(); }

  /// Whether its client is to be watched. Guarded by the server's mutex.
  bool needs_client() const noexcept
  {
    return !is_terminal(get_status()) || (watches_beyond_end && !handle.expired());
  }

  std::atomic<bool> result_sent{false};
  std::atomic<bool> watches_beyond_end{false};

  // --- guarded by the server's mutex ---

  /// Returns false if the state machine has no such transition.
  bool update(rcl_action_goal_event_t event);
  /// The server is gone: the goal is no longer active.
  void orphan() noexcept { status_ = GoalStatus::aborted; }

  std::weak_ptr<ServerGoalHandle> handle;
  bool in_handle_cancel = false;
  std::shared_ptr<void> result_response;          // set with a terminal status, constant from then on
  std::vector<rmw_request_id_t> result_requests;  // waiting for the result
  std::chrono::steady_clock::time_point ended{};
  std::optional<ClientWatch> client;  // while the client is watched

 private:
  const std::weak_ptr<ActionServerImpl> server_;
  const GoalUUID id_;
  rcl_action_goal_handle_t rcl_handle_;
  std::int64_t stamp_ = 0;
  std::atomic<GoalStatus> status_{GoalStatus::accepted};
};

}  // namespace rcl_cxx::detail
