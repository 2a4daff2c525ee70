#include "rcl_cxx/publisher.hpp"

#include <fmt/format.h>

#include "node_core.hpp"
#include "publisher_core.hpp"
#include "qos_rmw.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
constexpr std::chrono::seconds kFailureLogPeriod{1};
}

std::shared_ptr<PublisherCore> PublisherCore::create(std::shared_ptr<NodeCore> node,
                                                     const rosidl_message_type_support_t * type_support,
                                                     const std::string & topic, const QoS & qos)
{
  auto core = std::make_shared<PublisherCore>(std::move(node), type_support, topic, qos);
  core->warning_ = std::make_unique<QosWarning>();
  core->warning_->start(core->publisher_, &on_event, core->source(0));
  return core;
}

PublisherCore::PublisherCore(std::shared_ptr<NodeCore> node,
                             const rosidl_message_type_support_t * type_support, const std::string & topic,
                             const QoS & qos)
    : Entity(std::move(node), fmt::format("publisher {}", topic)),
      publisher_(rcl_get_zero_initialized_publisher())
{
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = to_rmw(qos);
  const std::lock_guard lock(this->node()->mutex());
  check_rcl(rcl_publisher_init(&publisher_, this->node()->handle(), type_support, topic.c_str(), &options),
            label(), "cannot be created");
  topic_ = rcl_publisher_get_topic_name(&publisher_);
}

PublisherCore::~PublisherCore()
{
  const std::lock_guard lock(node()->mutex());
  warning_.reset();
  ignore_rcl(rcl_publisher_fini(&publisher_, node()->handle()));
}

bool PublisherCore::publish(const void * message) noexcept
{
  const rcl_ret_t code = rcl_publish(&publisher_, message, nullptr);
  if (code == RCL_RET_OK) {
    return true;
  }
  const bool shut_down =
      !rcl_publisher_is_valid(&publisher_) && rcl_publisher_is_valid_except_context(&publisher_);
  if (!shut_down && throttle_passes(last_failure_ns_, kFailureLogPeriod)) {
    const rcl_error_string_t reason = rcl_get_error_string();
    RCL_CXX_ERROR(node()->logger(), "{}: message not published (rcl error {}: {})", label(), code,
                  reason.str);
  }
  rcl_reset_error();
  return false;
}

std::size_t PublisherCore::subscription_count() const
{
  std::size_t count = 0;
  if (rcl_publisher_get_subscription_count(&publisher_, &count) != RCL_RET_OK) {
    rcl_reset_error();  // after the shutdown
    return 0;
  }
  return count;
}

void PublisherCore::execute(std::size_t /*source*/)
{
  const std::string policy = warning_->take_policy();
  if (!policy.empty()) {
    RCL_CXX_WARN(node()->logger(),
                 "{}: a subscription asks for another quality of service ({}), it gets no messages", topic_,
                 policy);
  }
}

void PublisherCore::stop() noexcept
{
  warning_->stop();
}
}  // namespace detail

PublisherBase::PublisherBase(std::shared_ptr<detail::PublisherCore> core) : core_(std::move(core)) {}
PublisherBase::~PublisherBase()
{
  core_->close();
}
const std::string & PublisherBase::topic_name() const noexcept
{
  return core_->topic_name();
}
std::size_t PublisherBase::subscription_count() const
{
  return core_->subscription_count();
}
bool PublisherBase::publish_message(const void * message) noexcept
{
  return core_->publish(message);
}

}  // namespace rcl_cxx
