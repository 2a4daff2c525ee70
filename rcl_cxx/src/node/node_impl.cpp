#include "node/node_impl.hpp"

#include <fmt/format.h>
#include <rcl/logging.h>
#include <rcl/node_options.h>

#include <utility>

#include "context/arguments.hpp"
#include "context/logging_impl.hpp"
#include "rcl_support/rcl_compat.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
NodeImpl::NodeImpl(std::shared_ptr<ContextImpl> context, const std::string & name,
                   const std::string & node_namespace)
    : context_impl_(std::move(context)), logger_(name)
{
  const rcl_node_options_t options = rcl_node_get_default_options();
  {
    const std::lock_guard lock(logging_mutex());
    check_rcl(rcl_node_init(&node_, name.c_str(), node_namespace.c_str(), context_impl_->handle(), &options),
              fmt::format("node '{}' in namespace '{}'", name, node_namespace), "cannot be created");
    name_ = rcl_node_get_name(&node_);
    namespace_ = rcl_node_get_namespace(&node_);
    fully_qualified_name_ = rcl_node_get_fully_qualified_name(&node_);
    logger_ = Logger(rcl_node_get_logger_name(&node_));
    if (!rcl_logging_rosout_enabled()) {
      return;
    }
    if (const rcl_ret_t code = compat::rosout_start(&node_); code != RCL_RET_OK) {
      const std::string details = take_rcl_error();
      ignore_rcl(rcl_node_fini(&node_));
      throw Error(fmt::format("node {}: /rosout cannot be created: {}", fully_qualified_name_, details),
                  code);
    }
    has_rosout_ = true;
  }
  // Later messages go to the console and the log file: rcl would report that it cannot publish them.
  rosout_end_ = context_impl_->add_callback(ContextImpl::Phase::rosout, [this] { end_rosout(); });
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

NodeImpl::CreationLock NodeImpl::lock_to_create(const std::string & label)
{
  CreationLock lock{std::unique_lock(mutex_), std::shared_lock(context_impl_->creation_mutex())};
  if (!context_impl_->ok()) {
    throw Error(fmt::format("{}: cannot be created: shutting down", label), RCL_RET_ERROR);
  }
  return lock;
}

std::string NodeImpl::resolve(const std::string & name, bool is_service) const
{
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  char * resolved = nullptr;
  check_rcl(rcl_node_resolve_name(&node_, name.c_str(), allocator, is_service, false, &resolved),
            fully_qualified_name_, fmt::format("'{}' is not a valid name", name));
  std::string result = resolved;
  allocator.deallocate(resolved, allocator.state);
  return result;
}

std::map<std::string, ParameterValue> NodeImpl::read_parameter_overrides() const
{
  return detail::read_parameter_overrides(context_impl_->handle()->global_arguments, fully_qualified_name_);
}

}  // namespace rcl_cxx::detail
