#pragma once

#include <rcl_action/action_client.h>

#include <action_msgs/srv/cancel_goal.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "executor/waitable.hpp"
#include "rcl_cxx_test/action_client.hpp"
#include "rcl_support/type_support.hpp"

namespace rcl_cxx::detail {
/// A goal from its sending until its result has arrived. Shared with the user's handle.
class ClientGoalImpl {
 public:
  ClientGoalImpl(std::weak_ptr<ActionClientImpl> client, GoalUUID id) : client_(std::move(client)), id_(id) {}

  const GoalUUID & id() const noexcept { return id_; }
  std::shared_ptr<ActionClientImpl> client() const noexcept { return client_.lock(); }

  std::atomic<GoalStatus> status{GoalStatus::unknown};

  // Guarded by the client's mutex. A callback is removed when it is called: it holds a promise whose value
  // holds this object.
  ErasedGoalCallbacks callbacks;
  bool abandoned = false;

 private:
  const std::weak_ptr<ActionClientImpl> client_;
  const GoalUUID id_;
};

class ActionClientImpl : public Waitable {
 public:
  ActionClientImpl(std::shared_ptr<NodeImpl> node, const ActionClientOps & ops, const std::string & name);
  ~ActionClientImpl() override;

  const std::string & get_action_name() const noexcept { return name_; }
  bool action_server_is_ready() const;

  GoalUUID send(const void * goal, ErasedGoalCallbacks callbacks);
  void abandon(const GoalUUID & id) noexcept;
  std::future<CancelResponse> cancel(const GoalUUID & id, std::int64_t stamp_ns);
  /// Drops everything that waits for a response. Sends nothing afterwards.
  void retire();

  void set_on_ready_callbacks() override;

 protected:
  void execute(std::size_t source) override;
  void clear_on_ready_callbacks() noexcept override;

 private:
  using Goal = std::shared_ptr<ClientGoalImpl>;

  void take_goal_response();
  void take_cancel_response();
  void take_result_response();
  void take_feedback();
  void take_status();
  void on_accepted(const Goal & goal);
  void on_rejected(const Goal & goal);
  Goal find(const GoalUUID & id) const;

  const ActionClientOps & ops_;
  const ActionTypeSupport type_support_;
  std::string name_;
  rcl_action_client_t client_ = rcl_action_get_zero_initialized_client();

  mutable std::mutex mutex_;
  bool retired_ = false;
  std::map<std::int64_t, Goal> unanswered_;      // by sequence number of the goal request
  std::map<std::int64_t, Goal> without_result_;  // by sequence number of the result request
  std::map<GoalUUID, Goal> goals_;               // without a result
  std::map<std::int64_t, std::promise<CancelResponse>> cancellations_;
};

}  // namespace rcl_cxx::detail
