#include "rcl_cxx/publisher.hpp"

#include <fmt/format.h>
#include <rcl/publisher.h>

#include <atomic>
#include <cstdint>

#include "executor/waitable.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/type_support.hpp"
#include "topics/qos_event.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
constexpr std::chrono::seconds kFailureLogPeriod{1};
}

class PublisherImpl : public Waitable {
 public:
  PublisherImpl(std::shared_ptr<NodeImpl> node, const rosidl_message_type_support_t * type_support,
                const std::string & topic, const QoS & qos);
  ~PublisherImpl() override;

  bool publish(const void * message) noexcept;
  std::size_t get_subscription_count() const;
  const std::string & get_topic_name() const noexcept { return topic_; }

  void set_on_ready_callbacks() override
  {
    incompatible_qos_.start(rcl_publisher_event_init, publisher_, RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
                            [this](rcl_event_t & event) { set_callback(rcl_event_set_callback, event, 0); });
  }

 protected:
  void execute(std::size_t source) override;
  void clear_on_ready_callbacks() noexcept override { incompatible_qos_.stop(); }

 private:
  const MessageTypeSupport type_support_;
  rcl_publisher_t publisher_ = rcl_get_zero_initialized_publisher();
  std::string topic_;
  IncompatibleQosEvent incompatible_qos_;
  std::atomic<std::int64_t> last_failure_ns_{INT64_MIN};
};

PublisherImpl::PublisherImpl(std::shared_ptr<NodeImpl> node,
                             const rosidl_message_type_support_t * type_support, const std::string & topic,
                             const QoS & qos)
    : Waitable(std::move(node), fmt::format("publisher {}", topic)), type_support_(type_support)
{
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = qos.get_rmw_qos_profile();
  const auto lock = this->node()->lock_to_create(label());
  check_rcl(
      rcl_publisher_init(&publisher_, this->node()->handle(), type_support_.get(), topic.c_str(), &options),
      label(), "cannot be created");
  reset_type_support_error();
  topic_ = rcl_publisher_get_topic_name(&publisher_);
}

PublisherImpl::~PublisherImpl()
{
  const std::lock_guard lock(node()->mutex());
  incompatible_qos_.fini();
  ignore_rcl(rcl_publisher_fini(&publisher_, node()->handle()));
}

bool PublisherImpl::publish(const void * message) noexcept
{
  const rcl_ret_t code = guard_serialization([&] { return rcl_publish(&publisher_, message, nullptr); });
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
  if (const auto policy = incompatible_qos_.take_policy()) {
    RCL_CXX_WARN(
        node()->get_logger(),
        "{}: a subscription requests an incompatible quality of service ({}), it receives no messages",
        topic_, *policy);
  }
}
}  // namespace detail

PublisherBase::PublisherBase(std::shared_ptr<detail::NodeImpl> node,
                             const rosidl_message_type_support_t * type_support, const std::string & topic,
                             const QoS & qos)
    : impl_(detail::make_waitable<detail::PublisherImpl>(std::move(node), type_support, topic, qos))
{
}
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
