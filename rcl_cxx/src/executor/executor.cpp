#include "rcl_cxx/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "context/context_impl.hpp"
#include "events/event_queue.hpp"
#include "executor/waitable.hpp"
#include "node/node_impl.hpp"
#include "rcl_cxx/error.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/node.hpp"

namespace rcl_cxx {
namespace {
using Clock = detail::EventQueue::Clock;

constexpr std::chrono::milliseconds kConditionCheckPeriod{10};

void execute(const detail::Event & event) noexcept
{
  if (!event.task) {
    if (const auto waitable = event.waitable.lock()) {
      waitable->take_and_execute(event.source);
    }
    return;
  }
  static const Logger logger("rcl_cxx");
  try {
    event.task();
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(logger, "executor: the posted task failed: {}", error.what());
  } catch (...) {
    RCL_CXX_ERROR(logger, "executor: the posted task threw an unknown exception");
  }
}
}  // namespace

/// Marks the thread that spins. Rejects a second one, and a nested spin in a callback.
class Executor::Spinning {
 public:
  explicit Spinning(Executor & executor) : executor_(executor), outer_(detail::EventQueue::current())
  {
    if (executor_.spinning_.exchange(true)) {
      throw Error("executor: it is spinning already; callbacks must not spin");
    }
    detail::EventQueue::current() = executor_.queue_.get();
  }
  ~Spinning()
  {
    detail::EventQueue::current() = outer_;
    executor_.queue_->take_cancel();
    executor_.spinning_ = false;
  }
  Spinning(const Spinning &) = delete;
  Spinning & operator=(const Spinning &) = delete;

 private:
  Executor & executor_;
  const detail::EventQueue * const outer_;
};

Executor::Executor(Context::SharedPtr context)
    : context_(std::move(context)),
      queue_(std::make_shared<detail::EventQueue>()),
      shutdown_callback_(context_->add_on_shutdown_callback([queue = queue_] { queue->end(); }))
{
}

Executor::~Executor()
{
  context_->remove_shutdown_callback(shutdown_callback_);
}

void Executor::add_node(const Node & node)
{
  if (!node.impl()->default_group()->pending_events().attach(queue_)) {
    throw Error(fmt::format("executor: node {} has an executor already", node.get_fully_qualified_name()));
  }
}

void Executor::add_callback_group(const CallbackGroup & group)
{
  if (!group.pending_events().attach(queue_)) {
    throw Error("executor: the callback group has an executor already");
  }
}

void Executor::spin()
{
  const Spinning spinning(*this);
  while (const auto event = queue_->next(Clock::time_point::max())) {
    execute(*event);
  }
}

bool Executor::spin_until(const std::function<bool()> & condition, std::chrono::nanoseconds timeout)
{
  const Spinning spinning(*this);
  const Clock::time_point start = Clock::now();
  while (!condition()) {
    const auto left = timeout - (Clock::now() - start);
    if (left <= std::chrono::nanoseconds::zero() || queue_->is_canceled_or_ended()) {
      return condition();
    }
    const auto wait = std::min<std::chrono::nanoseconds>(left, kConditionCheckPeriod);
    if (const auto event = queue_->next(Clock::now() + wait)) {
      execute(*event);
    }
  }
  return true;
}

void Executor::cancel()
{
  queue_->cancel();
}

void Executor::post(std::function<void()> task)
{
  queue_->push(detail::Event{{}, 0, std::move(task)});
}

}  // namespace rcl_cxx
