#include "rcl_cxx/context.hpp"

#include <rcl/context.h>

#include "context_impl.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx {
namespace {
std::shared_ptr<detail::ContextImpl> make_impl(const std::vector<std::string> & arguments,
                                               const InitOptions & options)
{
  std::vector<const char *> argv;
  for (const std::string & argument : arguments) {
    argv.push_back(argument.c_str());
  }
  return std::make_shared<detail::ContextImpl>(static_cast<int>(argv.size()), argv.data(), options);
}
}  // namespace

Context::Context(int argc, const char * const * argv, const InitOptions & options)
    : Context(std::vector<std::string>(argv, argv + argc), options)
{
}

Context::Context(const std::vector<std::string> & arguments, const InitOptions & options)
    : impl_(make_impl(arguments, options))
{
  if (options.shutdown_on_signal) {
    impl_->watch_signals();
  }
}

Context::~Context()
{
  shutdown("the context was destroyed");
  impl_->join_signal_thread();
}

bool Context::ok() const noexcept
{
  return impl_->ok();
}

bool Context::shutdown(const std::string & reason)
{
  return impl_->shutdown(reason);
}

std::string Context::shutdown_reason() const
{
  return impl_->shutdown_reason();
}

bool Context::wait_for_shutdown(std::chrono::nanoseconds timeout) const
{
  return impl_->wait_for(timeout, true);
}

bool Context::wait_for_shutdown_begin(std::chrono::nanoseconds timeout) const
{
  return impl_->wait_for(timeout, false);
}

std::size_t Context::add_pre_shutdown_callback(Callback callback)
{
  return impl_->add_callback(detail::ContextImpl::Phase::user_before, std::move(callback));
}

std::size_t Context::add_on_shutdown_callback(Callback callback)
{
  return impl_->add_callback(detail::ContextImpl::Phase::after, std::move(callback));
}

void Context::remove_shutdown_callback(std::size_t id)
{
  impl_->remove_callback(id);
}

const std::vector<std::string> & Context::non_ros_arguments() const noexcept
{
  return impl_->non_ros_arguments();
}

std::size_t Context::get_domain_id() const
{
  std::size_t id = 0;
  detail::check_rcl(rcl_context_get_domain_id(impl_->handle(), &id), "context", "has no domain id");
  return id;
}

}  // namespace rcl_cxx
