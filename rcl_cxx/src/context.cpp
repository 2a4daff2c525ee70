#include "rcl_cxx/context.hpp"

#include <rcl/context.h>

#include "context_core.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx {
namespace {
std::shared_ptr<detail::ContextCore> make_core(const std::vector<std::string> & arguments,
                                               const ContextOptions & options)
{
  std::vector<const char *> argv;
  for (const std::string & argument : arguments) {
    argv.push_back(argument.c_str());
  }
  return std::make_shared<detail::ContextCore>(static_cast<int>(argv.size()), argv.data(), options);
}
}  // namespace

Context::Context(int argc, const char * const * argv, const ContextOptions & options)
    : Context(std::vector<std::string>(argv, argv + argc), options)
{
}

Context::Context(const std::vector<std::string> & arguments, const ContextOptions & options)
    : core_(make_core(arguments, options))
{
  if (options.handle_signals) {
    core_->watch_signals();
  }
}

Context::~Context()
{
  shutdown("the context was destroyed");
  core_->join_signal_thread();
}

bool Context::ok() const noexcept
{
  return core_->ok();
}

bool Context::shutdown(const std::string & reason)
{
  return core_->shutdown(reason);
}

std::string Context::shutdown_reason() const
{
  return core_->shutdown_reason();
}

bool Context::wait_for_shutdown(std::chrono::nanoseconds timeout) const
{
  return core_->wait_for(timeout, true);
}

bool Context::wait_for_shutdown_begin(std::chrono::nanoseconds timeout) const
{
  return core_->wait_for(timeout, false);
}

std::size_t Context::on_pre_shutdown(Callback callback)
{
  return core_->add_callback(detail::ContextCore::Phase::user_before, std::move(callback));
}

std::size_t Context::on_shutdown(Callback callback)
{
  return core_->add_callback(detail::ContextCore::Phase::after, std::move(callback));
}

void Context::remove_callback(std::size_t id)
{
  core_->remove_callback(id);
}

const std::vector<std::string> & Context::non_ros_arguments() const noexcept
{
  return core_->non_ros_arguments();
}

std::size_t Context::domain_id() const
{
  std::size_t id = 0;
  detail::check_rcl(rcl_context_get_domain_id(core_->handle(), &id), "context", "has no domain id");
  return id;
}

}  // namespace rcl_cxx
