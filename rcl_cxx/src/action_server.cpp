#include "rcl_cxx/action_server.hpp"

#include "action_server_impl.hpp"

namespace rcl_cxx {
ActionServerBase::ActionServerBase(std::shared_ptr<detail::ActionServerImpl> impl) : impl_(std::move(impl)) {}
ActionServerBase::~ActionServerBase()
{
  impl_->retire();
}
const std::string & ActionServerBase::get_action_name() const noexcept
{
  return impl_->get_action_name();
}
std::size_t ActionServerBase::active_goal_count() const
{
  return impl_->active_goal_count();
}

}  // namespace rcl_cxx
