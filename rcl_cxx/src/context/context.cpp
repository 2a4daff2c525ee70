#include "rcl_cxx/context.hpp"

#include "context/context_impl.hpp"

namespace rcl_cxx {
Context::Context(int argc, const char * const * argv, const InitOptions & options)
    : Context(std::vector<std::string>(argv, argv + argc), options)
{
}

Context::Context(const std::vector<std::string> & arguments, const InitOptions & options)
    : impl_(std::make_shared<detail::ContextImpl>(arguments, options))
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
  return impl_->add_callback(detail::ContextImpl::Phase::pre_shutdown, std::move(callback));
}

std::size_t Context::add_on_shutdown_callback(Callback callback)
{
  return impl_->add_callback(detail::ContextImpl::Phase::on_shutdown, std::move(callback));
}

void Context::remove_shutdown_callback(std::size_t id)
{
  impl_->remove_callback(id);
}

const std::vector<std::string> & Context::non_ros_arguments() const noexcept
{
  return impl_->non_ros_arguments();
}

}  // namespace rcl_cxx
