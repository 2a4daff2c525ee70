#include "node_impl.hpp"

#include <fmt/format.h>
#include <rcl/logging.h>
#include <rcl/node_options.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "logging_impl.hpp"
#include "rcl_compat.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
// The graph's changes are announced through guard conditions only, which want a wait set of their own; a
// query takes microseconds.
constexpr std::chrono::milliseconds kGraphCheckPeriod{5};
}  // namespace

NodeImpl::NodeImpl(std::shared_ptr<ContextImpl> context, const std::string & name,
                   const std::string & node_namespace, const NodeOptions & options,
                   const rcl_arguments_t & arguments)
    : context_impl_(std::move(context)), node_(rcl_get_zero_initialized_node()), logger_(name)
{
  rcl_node_options_t node_options = rcl_node_get_default_options();
  node_options.use_global_arguments = options.use_global_arguments;
  node_options.enable_rosout = options.enable_rosout;
  node_options.arguments = arguments;  // copied by rcl
  std::unique_lock lock(logging_mutex());
  check_rcl(
      rcl_node_init(&node_, name.c_str(), node_namespace.c_str(), context_impl_->handle(), &node_options),
      fmt::format("node '{}' in namespace '{}'", name, node_namespace), "cannot be created");
  name_ = rcl_node_get_name(&node_);
  namespace_ = rcl_node_get_namespace(&node_);
  fully_qualified_name_ = rcl_node_get_fully_qualified_name(&node_);
  logger_ = Logger(rcl_node_get_logger_name(&node_));
  if (options.enable_rosout && rcl_logging_rosout_enabled()) {
    start_rosout();
    lock.unlock();
    // Later messages go to the console and the log file: rcl would report that it cannot publish them.
    rosout_end_ = context_impl_->add_callback(ContextImpl::Phase::rosout, [this] { end_rosout(); });
  }
}

void NodeImpl::start_rosout()
{
  const rcl_ret_t code = compat::rosout_start(&node_);
  has_rosout_ = code == RCL_RET_OK;
  if (!has_rosout_) {
    const std::string details = take_rcl_error();
    ignore_rcl(rcl_node_fini(&node_));
    throw Error(fmt::format("node {}: no /rosout: {}", fully_qualified_name_, details), code);
  }
}

void NodeImpl::end_rosout()
{
  const std::lock_guard lock(logging_mutex());
  if (std::exchange(has_rosout_, false)) {
    ignore_rcl(compat::rosout_stop(&node_));
  }
}

NodeImpl::~NodeImpl()
{
  context_impl_->remove_callback(rosout_end_);
  end_rosout();
  const std::lock_guard lock(logging_mutex());
  ignore_rcl(rcl_node_fini(&node_));
}

std::string NodeImpl::resolve(const std::string & name, bool is_service) const
{
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  char * resolved = nullptr;
  check_rcl(rcl_node_resolve_name(&node_, name.c_str(), allocator, is_service, false, &resolved),
            fully_qualified_name_, fmt::format("'{}' is no valid name", name));
  std::string result = resolved;
  allocator.deallocate(resolved, allocator.state);
  return result;
}

bool NodeImpl::in_own_callback() const
{
  const auto queue = pending_events_.queue();
  return queue && queue.get() == EventQueue::current();
}

bool NodeImpl::wait_for(const std::function<bool()> & condition, std::chrono::nanoseconds timeout) const
{
  const auto start = std::chrono::steady_clock::now();
  while (context_impl_->ok()) {
    if (condition()) {
      return true;
    }
    const auto left = timeout - (std::chrono::steady_clock::now() - start);
    if (left <= std::chrono::nanoseconds::zero()) {
      return false;
    }
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(left, kGraphCheckPeriod));
  }
  return false;
}

std::string NodeImpl::executor_hint() const
{
  return pending_events_.queue() ? "" : " (the node is in no executor, nothing can arrive)";
}

}  // namespace rcl_cxx::detail
