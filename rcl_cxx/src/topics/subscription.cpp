#include "rcl_cxx/subscription.hpp"

#include <fmt/format.h>
#include <rcl/subscription.h>

#include <algorithm>

#include "executor/waitable.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/type_support.hpp"
#include "topics/qos_event.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
MessageInfo to_message_info(const rmw_message_info_t & rmw_info)
{
  MessageInfo info;
  std::ranges::copy(rmw_info.publisher_gid.data, info.publisher.begin());
  info.published = decltype(info.published)(std::chrono::nanoseconds(rmw_info.source_timestamp));
  if (rmw_info.publication_sequence_number != RMW_MESSAGE_INFO_SEQUENCE_NUMBER_UNSUPPORTED) {
    info.number = rmw_info.publication_sequence_number;
  }
  return info;
}
}  // namespace

class SubscriptionImpl : public Waitable {
 public:
  SubscriptionImpl(std::shared_ptr<NodeImpl> node, ErasedSubscription erased, const std::string & topic,
                   const QoS & qos, CallbackGroup::SharedPtr group);
  ~SubscriptionImpl() override;

  const std::string & get_topic_name() const noexcept { return topic_; }

  /// Returns false if there is no message.
  bool take(void * message, MessageInfo & info);

  void set_on_ready_callbacks() override;

 protected:
  void execute(std::size_t source) override;
  void clear_on_ready_callbacks() noexcept override;
  const CallbackGroup & group(std::size_t) const override { return *group_; }

 private:
  enum Source : std::size_t { kMessage, kQosEvent };

  const ErasedSubscription erased_;
  const CallbackGroup::SharedPtr group_;
  const MessageTypeSupport type_support_;
  rcl_subscription_t subscription_ = rcl_get_zero_initialized_subscription();
  std::string topic_;
  IncompatibleQosEvent incompatible_qos_;
  std::shared_ptr<void> message_;  // reused unless a callback has kept it
};

SubscriptionImpl::SubscriptionImpl(std::shared_ptr<NodeImpl> node, ErasedSubscription erased,
                                   const std::string & topic, const QoS & qos, CallbackGroup::SharedPtr group)
    : Waitable(std::move(node), fmt::format("subscription {}", topic)),
      erased_(std::move(erased)),
      group_(group ? std::move(group) : this->node()->default_group()),
      type_support_(erased_.type_support)
{
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos.get_rmw_qos_profile();
  const auto lock = this->node()->lock_to_create(label());
  const rcl_ret_t code = rcl_subscription_init(&subscription_, this->node()->handle(), type_support_.get(),
                                               topic.c_str(), &options);
  ignore_rcl(rcl_subscription_options_fini(&options));
  check_rcl(code, label(), "cannot be created");
  reset_type_support_error();
  topic_ = rcl_subscription_get_topic_name(&subscription_);
}

SubscriptionImpl::~SubscriptionImpl()
{
  const std::lock_guard lock(node()->mutex());
  incompatible_qos_.fini();
  ignore_rcl(rcl_subscription_fini(&subscription_, node()->handle()));
}

void SubscriptionImpl::set_on_ready_callbacks()
{
  set_callback(rcl_subscription_set_on_new_message_callback, subscription_, kMessage);
  incompatible_qos_.start(
      rcl_subscription_event_init, subscription_, RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS,
      [this](rcl_event_t & event) { set_callback(rcl_event_set_callback, event, kQosEvent); });
}

void SubscriptionImpl::clear_on_ready_callbacks() noexcept
{
  clear_callback(rcl_subscription_set_on_new_message_callback, subscription_);
  incompatible_qos_.stop();
}

void SubscriptionImpl::execute(std::size_t source)
{
  if (source == kQosEvent) {
    if (const auto policy = incompatible_qos_.take_policy()) {
      RCL_CXX_WARN(
          node()->get_logger(),
          "{}: a publisher offers an incompatible quality of service ({}), its messages are not received",
          topic_, *policy);
    }
    return;
  }
  if (!message_ || message_.use_count() > 1) {
    message_ = erased_.make_message();
  }
  MessageInfo info;
  if (take(message_.get(), info)) {
    erased_.callback(message_, info);
  }
}

bool SubscriptionImpl::take(void * message, MessageInfo & info)
{
  rmw_message_info_t rmw_info = rmw_get_zero_initialized_message_info();
  const rcl_ret_t code = rcl_take(&subscription_, message, &rmw_info, nullptr);
  if (code == RCL_RET_SUBSCRIPTION_TAKE_FAILED) {
    rcl_reset_error();
    return false;
  }
  check_rcl(code, label(), "cannot take a message");
  info = to_message_info(rmw_info);
  return true;
}
}  // namespace detail

SubscriptionBase::SubscriptionBase(std::shared_ptr<detail::NodeImpl> node, detail::ErasedSubscription erased,
                                   const std::string & topic, const QoS & qos, CallbackGroup::SharedPtr group)
    : impl_(detail::make_waitable<detail::SubscriptionImpl>(std::move(node), std::move(erased), topic, qos,
                                                            std::move(group)))
{
}
SubscriptionBase::~SubscriptionBase()
{
  impl_->close();
}
bool SubscriptionBase::take(void * message)
{
  MessageInfo info;
  return impl_->take(message, info);
}
const std::string & SubscriptionBase::get_topic_name() const noexcept
{
  return impl_->get_topic_name();
}

}  // namespace rcl_cxx
