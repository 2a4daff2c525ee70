#include "rcl_cxx/executor.hpp"

#include <fmt/format.h>

#include <exception>

#include "context_impl.hpp"
#include "event_queue.hpp"
#include "node_impl.hpp"
#include "pending_events.hpp"
#include "rcl_cxx/error.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/node.hpp"
#include "waitable.hpp"

namespace rcl_cxx {
namespace {
using Clock = detail::EventQueue::Clock;

constexpr std::chrono::milliseconds kConditionCheckPeriod{10};

Clock::time_point after(std::chrono::nanoseconds duration)
{
  const Clock::time_point now = Clock::now();
  return duration >= Clock::time_point::max() - now ? Clock::time_point::max() : now + duration;
}

void run_task(const std::function<void()> & task) noexcept
{
  static const Logger logger("rcl_cxx");
  try {
    task();
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(logger, "task posted to the executor: {}", error.what());
  } catch (...) {
    RCL_CXX_ERROR(logger, "task posted to the executor: it threw something that is no std::exception");
  }
}

void serve(const detail::Event & event) noexcept
{
  if (event.task) {
    run_task(event.task);
  } else if (const auto waitable = event.waitable.lock()) {
    waitable->serve(event.source);
  }
}
}  // namespace

/// Marks that a thread spins; refuses a second one, also from within a callback.
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
    executor_.queue_->take_stop();
    executor_.spinning_ = false;
  }
  Spinning(const Spinning &) = delete;
  Spinning & operator=(const Spinning &) = delete;

 private:
  Executor & executor_;
  const detail::EventQueue * const outer_;
};

Executor::Executor(Context::SharedPtr context)
    : context_(std::move(context)), queue_(std::make_shared<detail::EventQueue>())
{
  end_callback_ =
      context_->impl()->add_callback(detail::ContextImpl::Phase::after, [queue = std::weak_ptr(queue_)] {
        if (const auto alive = queue.lock()) {
          alive->end();
        }
      });
}

Executor::~Executor()
{
  context_->impl()->remove_callback(end_callback_);
  for (const auto & weak : nodes_) {
    if (const auto node = weak.lock()) {
      node->pending_events().detach(*queue_);
    }
  }
}

void Executor::add_node(const Node & node)
{
  if (!node.impl()->pending_events().attach(queue_)) {
    throw Error(fmt::format("executor: node {} is in an executor already", node.get_fully_qualified_name()));
  }
  const std::lock_guard lock(nodes_mutex_);
  std::erase_if(nodes_, [](const auto & other) { return other.expired(); });
  nodes_.push_back(node.impl());
}

void Executor::add_node(const std::shared_ptr<Node> & node)
{
  add_node(*node);
}

void Executor::remove_node(const Node & node)
{
  node.impl()->pending_events().detach(*queue_);
  const std::lock_guard lock(nodes_mutex_);
  std::erase_if(nodes_, [&](const auto & other) { return other.lock() == node.impl(); });
}

void Executor::spin()
{
  const Spinning spinning(*this);
  while (const auto event = queue_->next(Clock::time_point::max())) {
    serve(*event);
  }
}

void Executor::spin_for(std::chrono::nanoseconds duration)
{
  const Spinning spinning(*this);
  const Clock::time_point deadline = after(duration);
  while (Clock::now() < deadline) {
    const auto event = queue_->next(deadline);
    if (!event) {
      return;
    }
    serve(*event);
  }
}

bool Executor::spin_until(const std::function<bool()> & condition, std::chrono::nanoseconds timeout)
{
  const Spinning spinning(*this);
  const Clock::time_point deadline = after(timeout);
  while (!condition()) {
    const Clock::time_point now = Clock::now();
    if (now >= deadline || queue_->ended() || queue_->stop_requested()) {
      return condition();
    }
    if (const auto event = queue_->next(std::min<Clock::time_point>(deadline, now + kConditionCheckPeriod))) {
      serve(*event);
    }
  }
  return true;
}

void Executor::cancel()
{
  queue_->stop();
}

void Executor::post(std::function<void()> task)
{
  queue_->push(detail::Event{{}, 0, std::move(task)});
}

bool Executor::in_callback_thread() const noexcept
{
  return detail::EventQueue::current() == queue_.get();
}

}  // namespace rcl_cxx
