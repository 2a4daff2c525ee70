#include "executor/waitable.hpp"

#include <exception>
#include <tuple>

#include "events/event_queue.hpp"
#include "node/node_impl.hpp"
#include "rcl_cxx/logging.hpp"

namespace rcl_cxx::detail {
Waitable::Waitable(std::shared_ptr<NodeImpl> node, std::string label)
    : node_(std::move(node)), label_(std::move(label))
{
  for (Source & source : sources_) {
    source.waitable = this;
  }
}

void Waitable::on_ready(const void * source, std::size_t count) noexcept
{
  // rcl passes on the pointer that set_callback() has given to it.
  const auto & origin = *static_cast<const Source *>(source);
  // One event in the queue represents all pending data of a source: this bounds the length of the queue.
  if (count > 0 && origin.pending.fetch_add(count) == 0) {
    origin.waitable->push_event(static_cast<std::size_t>(&origin - origin.waitable->sources_.data()));
  }
}

void Waitable::push_event(std::size_t source) noexcept
{
  group(source).pending_events().push(Event{weak_from_this(), source, {}});
}

const CallbackGroup & Waitable::group(std::size_t /*source*/) const
{
  return *node_->default_group();
}

void Waitable::take_and_execute(std::size_t source) noexcept
{
  {
    const std::lock_guard lock(sources_[source].callback);
    if (closed_) {
      return;
    }
    try {
      execute(source);
    } catch (const std::exception & error) {
      RCL_CXX_ERROR(node_->get_logger(), "{}: {}", label_, error.what());
    } catch (...) {
      RCL_CXX_ERROR(node_->get_logger(), "{}: the callback threw an unknown exception", label_);
    }
  }
  // The rest goes to the end of the queue, so that every waitable has its turn. A timer has no pending data.
  if (sources_[source].pending > 0 && sources_[source].pending.fetch_sub(1) > 1) {
    push_event(source);
  }
}

void Waitable::close() noexcept
{
  std::array<std::unique_lock<std::recursive_mutex>, std::tuple_size_v<decltype(sources_)>> locks;
  for (std::size_t i = 0; i < locks.size(); ++i) {
    locks[i] = std::unique_lock(sources_[i].callback);
  }
  if (!closed_) {
    closed_ = true;
    clear_on_ready_callbacks();
  }
}

}  // namespace rcl_cxx::detail
