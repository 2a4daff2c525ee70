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

#include "entity.hpp"
#include "rcl_cxx/action_client.hpp"

namespace rcl_cxx::detail {
/// A goal that was sent, until its result is here. The user's handle shares it.
class ClientGoalCore {
 public:
  ClientGoalCore(std::weak_ptr<ActionClientCore> client, GoalId id) : client_(std::move(client)), id_(id) {}

  const GoalId & id() const noexcept { return id_; }
  std::shared_ptr<ActionClientCore> client() const noexcept { return client_.lock(); }

  std::atomic<GoalStatus> status{GoalStatus::unknown};

  // Guarded by the client's lock. Each callback is moved away as it is used up: they hold promises whose
  // values hold this.
  ErasedGoalCallbacks callbacks;
  bool abandoned = false;

 private:
  const std::weak_ptr<ActionClientCore> client_;
  const GoalId id_;
};

class ActionClientCore : public Entity {
 public:
  static std::shared_ptr<ActionClientCore> create(std::shared_ptr<NodeCore> node, const ActionClientOps & ops,
                                                  const std::string & name,
                                                  const ActionClientOptions & options);
  ActionClientCore(std::shared_ptr<NodeCore> node, const ActionClientOps & ops, const std::string & name,
                   const ActionClientOptions & options);
  ~ActionClientCore() override;

  const std::string & action_name() const noexcept { return name_; }
  bool server_is_ready() const;

  GoalId send(const void * goal, ErasedGoalCallbacks callbacks);
  void abandon(const GoalId & id) noexcept;
  std::future<CancelResponse> cancel(const GoalId & id, std::int64_t stamp_ns);
  /// The user's client object is destroyed: drops all that waits for an answer, and sends nothing any more.
  void retire();

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  using Goal = std::shared_ptr<ClientGoalCore>;

  void start();
  void take_goal_response();
  void take_cancel_response();
  void take_result_response();
  void take_feedback();
  void take_status();
  void on_accepted(const Goal & goal);
  void on_refused(const Goal & goal);
  Goal find(const GoalId & id) const;

  const ActionClientOps & ops_;
  std::string name_;
  rcl_action_client_t client_;

  mutable std::mutex mutex_;
  bool retired_ = false;
  std::map<std::int64_t, Goal> unanswered_;      // by sequence number of the goal request
  std::map<std::int64_t, Goal> without_result_;  // by sequence number of the result request
  std::map<GoalId, Goal> goals_;                 // sent and not ended
  std::map<std::int64_t, std::promise<CancelResponse>> cancellations_;
};

}  // namespace rcl_cxx::detail
