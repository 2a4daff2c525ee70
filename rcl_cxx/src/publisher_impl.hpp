#pragma once

#include <rcl/publisher.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "qos_warning.hpp"
#include "rcl_cxx/qos.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
class PublisherImpl : public Waitable {
 public:
  static std::shared_ptr<PublisherImpl> create(std::shared_ptr<NodeImpl> node,
                                               const rosidl_message_type_support_t * type_support,
                                               const std::string & topic, const QoS & qos);
  PublisherImpl(std::shared_ptr<NodeImpl> node, const rosidl_message_type_support_t * type_support,
                const std::string & topic, const QoS & qos);
  ~PublisherImpl() override;

  /// As Publisher::publish.
  bool publish(const void * message) noexcept;
  std::size_t get_subscription_count() const;
  const std::string & get_topic_name() const noexcept { return topic_; }

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  rcl_publisher_t publisher_;
  std::string topic_;
  std::unique_ptr<QosWarning> warning_;
  std::atomic<std::int64_t> last_failure_ns_{INT64_MIN};
};

}  // namespace rcl_cxx::detail
