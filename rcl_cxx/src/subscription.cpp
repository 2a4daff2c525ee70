#include "rcl_cxx/subscription.hpp"

#include <fmt/format.h>

#include "node_impl.hpp"
#include "qos_rmw.hpp"
#include "rcl_error.hpp"
#include "subscription_impl.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
enum SubscriptionEvent : std::size_t { kMessage, kQos };
}

std::shared_ptr<SubscriptionImpl> SubscriptionImpl::create(std::shared_ptr<NodeImpl> node,
                                                           ErasedSubscription erased,
                                                           const std::string & topic, const QoS & qos)
{
  auto impl = std::make_shared<SubscriptionImpl>(std::move(node), std::move(erased), topic, qos);
  check_rcl(
      rcl_subscription_set_on_new_message_callback(&impl->subscription_, &on_event, impl->source(kMessage)),
      impl->label(), "its middleware does not report new messages");
  impl->warning_ = std::make_unique<QosWarning>();
  impl->warning_->start(impl->subscription_, &on_event, impl->source(kQos));
  return impl;
}

SubscriptionImpl::SubscriptionImpl(std::shared_ptr<NodeImpl> node, ErasedSubscription erased,
                                   const std::string & topic, const QoS & qos)
    : Waitable(std::move(node), fmt::format("subscription {}", topic)),
      erased_(std::move(erased)),
      subscription_(rcl_get_zero_initialized_subscription())
{
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = to_rmw(qos);
  const std::lock_guard lock(this->node()->mutex());
  const rcl_ret_t code = rcl_subscription_init(&subscription_, this->node()->handle(), erased_.type_support,
                                               topic.c_str(), &options);
  ignore_rcl(rcl_subscription_options_fini(&options));
  check_rcl(code, label(), "cannot be created");
  topic_ = rcl_subscription_get_topic_name(&subscription_);
}

SubscriptionImpl::~SubscriptionImpl()
{
  const std::lock_guard lock(node()->mutex());
  warning_.reset();
  ignore_rcl(rcl_subscription_fini(&subscription_, node()->handle()));
}

std::size_t SubscriptionImpl::get_publisher_count() const
{
  std::size_t count = 0;
  if (rcl_subscription_get_publisher_count(&subscription_, &count) != RCL_RET_OK) {
    rcl_reset_error();  // after the shutdown
    return 0;
  }
  return count;
}

void SubscriptionImpl::execute(std::size_t source)
{
  if (source == kQos) {
    warn_of_qos();
    return;
  }
  if (!message_ || message_.use_count() > 1) {
    message_ = erased_.make_message();
  }
  rmw_message_info_t info = rmw_get_zero_initialized_message_info();
  const rcl_ret_t code = rcl_take(&subscription_, message_.get(), &info, nullptr);
  if (code == RCL_RET_SUBSCRIPTION_TAKE_FAILED) {
    rcl_reset_error();
    return;
  }
  check_rcl(code, label(), "cannot take a message");
  erased_.callback(message_);
}

void SubscriptionImpl::warn_of_qos()
{
  const std::string policy = warning_->take_policy();
  if (!policy.empty()) {
    RCL_CXX_WARN(node()->get_logger(),
                 "{}: a publisher offers another quality of service ({}), its messages are not received",
                 topic_, policy);
  }
}

void SubscriptionImpl::stop() noexcept
{
  ignore_rcl(rcl_subscription_set_on_new_message_callback(&subscription_, nullptr, nullptr));
  if (warning_) {
    warning_->stop();
  }
}
}  // namespace detail

SubscriptionBase::SubscriptionBase(std::shared_ptr<detail::SubscriptionImpl> impl) : impl_(std::move(impl)) {}
SubscriptionBase::~SubscriptionBase()
{
  impl_->close();
}
const std::string & SubscriptionBase::get_topic_name() const noexcept
{
  return impl_->get_topic_name();
}
std::size_t SubscriptionBase::get_publisher_count() const
{
  return impl_->get_publisher_count();
}

}  // namespace rcl_cxx
