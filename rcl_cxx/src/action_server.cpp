#include "rcl_cxx/action_server.hpp"

#include "action_server_core.hpp"

namespace rcl_cxx {
ActionServerBase::ActionServerBase(std::shared_ptr<detail::ActionServerCore> core) : core_(std::move(core)) {}
ActionServerBase::~ActionServerBase()
{
  core_->retire();
}
const std::string & ActionServerBase::action_name() const noexcept
{
  return core_->action_name();
}
std::size_t ActionServerBase::active_goal_count() const
{
  return core_->active_goal_count();
}

}  // namespace rcl_cxx
