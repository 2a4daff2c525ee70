#include "action/action_announcement.hpp"

#include <fmt/format.h>
#include <rcl/event_callback.h>
#include <rcl_action/action_server.h>

#include "action/action_server_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_compat.hpp"

namespace rcl_cxx::detail {
namespace {
constexpr std::size_t kMatched = 0;
}

ActionAnnouncement::ActionAnnouncement(std::shared_ptr<NodeImpl> node, const ActionType & type,
                                       const std::string & name, ActionServerCallbacks callbacks,
                                       const ActionServerOptions & options)
    : Waitable(std::move(node), fmt::format("action {}", name)),
      type_(type),
      name_(name),
      callbacks_(std::move(callbacks)),
      options_(options),
      type_support_(type.type_support()->feedback_message_type_support)
{
  rcl_publisher_options_t publisher_options = rcl_publisher_get_default_options();
  publisher_options.qos = rcl_action_server_get_default_options().feedback_topic_qos;
  const std::string topic = this->node()->resolve(name, false) + "/_action/feedback";
  const auto lock = this->node()->lock_to_create(label());
  check_rcl(rcl_publisher_init(&publisher_, this->node()->handle(), type_support_.get(), topic.c_str(),
                               &publisher_options),
            label(), "cannot be announced");
  reset_type_support_error();
  reports_clients_ = compat::matched_event_init(&matched_, &publisher_) == RCL_RET_OK;
  rcl_reset_error();
}

ActionAnnouncement::~ActionAnnouncement()
{
  const std::lock_guard lock(node()->mutex());
  if (reports_clients_) {
    ignore_rcl(rcl_event_fini(&matched_));
  }
  ignore_rcl(rcl_publisher_fini(&publisher_, node()->handle()));
}

void ActionAnnouncement::set_on_ready_callbacks()
{
  if (!reports_clients_) {
    return create_server();
  }
  set_callback(rcl_event_set_callback, matched_, kMatched);
  notify(kMatched);  // a client may have been there before
}

void ActionAnnouncement::clear_on_ready_callbacks() noexcept
{
  if (reports_clients_) {
    clear_callback(rcl_event_set_callback, matched_);
  }
}

const CallbackGroup & ActionAnnouncement::group(std::size_t /*source*/) const
{
  return *options_.creation_callback_group;
}

void ActionAnnouncement::execute(std::size_t /*source*/)
{
  std::size_t clients = 0;
  if (server_ || !node()->get_context().ok() ||
      rcl_publisher_get_subscription_count(&publisher_, &clients) != RCL_RET_OK || clients == 0) {
    return rcl_reset_error();
  }
  create_server();
}

void ActionAnnouncement::create_server()
{
  server_ = make_waitable<ActionServerImpl>(node(), type_, name_, callbacks_, options_);
}

void ActionAnnouncement::retire() noexcept
{
  close();
  if (server_) {
    server_->retire();
  }
}

}  // namespace rcl_cxx::detail
