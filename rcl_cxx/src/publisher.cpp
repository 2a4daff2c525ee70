#include "rcl_cxx/publisher.hpp"

#include <fmt/format.h>

#include "node_impl.hpp"
#include "publisher_impl.hpp"
#include "qos_rmw.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
constexpr std::chrono::seconds kFailureLogPeriod{1};
}

std::shared_ptr<PublisherImpl> PublisherImpl::create(std::shared_ptr<NodeImpl> node,
                                                     const rosidl_message_type_support_t * type_support,
                                                     const std::string & topic, const QoS & qos)
{
  auto impl = std::make_shared<PublisherImpl>(std::move(node), type_support, topic, qos);
  impl->warning_ = std::make_unique<QosWarning>();
  impl->warning_->start(impl->publisher_, &on_event, impl->source(0));
  return impl;
}

PublisherImpl::PublisherImpl(std::shared_ptr<NodeImpl> node,
                             const rosidl_message_type_support_t * type_support, const std::string & topic,
                             const QoS & qos)
    : Waitable(std::move(node), fmt::format("publisher {}", topic)),
      publisher_(rcl_get_zero_initialized_publisher())
{
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = to_rmw(qos);
  const std::lock_guard lock(this->node()->mutex());
  check_rcl(rcl_publisher_init(&publisher_, this->node()->handle(), type_support, topic.c_str(), &options),
            label(), "cannot be created");
  topic_ = rcl_publisher_get_topic_name(&publisher_);
}

PublisherImpl::~PublisherImpl()
{
  const std::lock_guard lock(node()->mutex());
  warning_.reset();
  ignore_rcl(rcl_publisher_fini(&publisher_, node()->handle()));
}

bool PublisherImpl::publish(const void * message) noexcept
{
  const rcl_ret_t code = rcl_publish(&publisher_, message, nullptr);
  if (code == RCL_RET_OK) {
    return true;
  }
  const bool shut_down =
      !rcl_publisher_is_valid(&publisher_) && rcl_publisher_is_valid_except_context(&publisher_);
  if (!shut_down && throttle_passes(last_failure_ns_, kFailureLogPeriod)) {
    const rcl_error_string_t reason = rcl_get_error_string();
    RCL_CXX_ERROR(node()->get_logger(), "{}: message not published (rcl error {}: {})", label(), code,
                  reason.str);
  }
  rcl_reset_error();
  return false;
}

std::size_t PublisherImpl::get_subscription_count() const
{
  std::size_t count = 0;
  if (rcl_publisher_get_subscription_count(&publisher_, &count) != RCL_RET_OK) {
    rcl_reset_error();  // after the shutdown
    return 0;
  }
  return count;
}

void PublisherImpl::execute(std::size_t /*source*/)
{
  const std::string policy = warning_->take_policy();
  if (!policy.empty()) {
    RCL_CXX_WARN(node()->get_logger(),
                 "{}: a subscription asks for another quality of service ({}), it gets no messages", topic_,
                 policy);
  }
}

void PublisherImpl::stop() noexcept
{
  warning_->stop();
}
}  // namespace detail

PublisherBase::PublisherBase(std::shared_ptr<detail::PublisherImpl> impl) : impl_(std::move(impl)) {}
PublisherBase::~PublisherBase()
{
  impl_->close();
}
const std::string & PublisherBase::get_topic_name() const noexcept
{
  return impl_->get_topic_name();
}
std::size_t PublisherBase::get_subscription_count() const
{
  return impl_->get_subscription_count();
}
bool PublisherBase::publish_message(const void * message) noexcept
{
  return impl_->publish(message);
}

}  // namespace rcl_cxx
