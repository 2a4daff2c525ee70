#include "waitable.hpp"

#include <exception>

#include "node_impl.hpp"
#include "pending_events.hpp"
#include "rcl_cxx/logging.hpp"

namespace rcl_cxx::detail {
Waitable::Waitable(std::shared_ptr<NodeImpl> node, std::string label)
    : node_(std::move(node)), label_(std::move(label))
{
  for (Source & source : sources_) {
    source.waitable = this;
  }
}

void Waitable::on_event(const void * source, std::size_t count) noexcept
{
  // rcl carries the pointer as const, it comes from source().
  auto * const origin = static_cast<Source *>(const_cast<void *>(source));
  const auto index = static_cast<std::size_t>(origin - origin->waitable->sources_.data());
  origin->waitable->notify(index, count);
}

void Waitable::notify(std::size_t source, std::size_t count) noexcept
{
  // One event in the queue stands for all that is pending: the queue's length is bounded by the number of
  // entities.
  if (count > 0 && sources_[source].pending.fetch_add(count) == 0) {
    node_->pending_events().push(Event{weak_from_this(), source, {}});
  }
}

void Waitable::serve(std::size_t source) noexcept
{
  {
    const std::lock_guard lock(callback_);
    if (closed_) {
      return;
    }
    try {
      execute(source);
    } catch (const std::exception & error) {
      RCL_CXX_ERROR(node_->get_logger(), "{}: {}", label_, error.what());
    } catch (...) {
      RCL_CXX_ERROR(node_->get_logger(), "{}: the callback threw something that is no std::exception",
                    label_);
    }
  }
  // The rest goes to the end of the queue: nobody starves the others.
  if (source < kSources && sources_[source].pending.fetch_sub(1) > 1) {
    node_->pending_events().push(Event{weak_from_this(), source, {}});
  }
}

void Waitable::close() noexcept
{
  const std::lock_guard lock(callback_);
  if (!closed_) {
    closed_ = true;
    stop();
  }
}

}  // namespace rcl_cxx::detail
