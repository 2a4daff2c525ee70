#pragma once

#include <rcl/subscription.h>

#include <memory>
#include <string>

#include "qos_warning.hpp"
#include "rcl_cxx/qos.hpp"
#include "rcl_cxx/subscription.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
class SubscriptionImpl : public Waitable {
 public:
  static std::shared_ptr<SubscriptionImpl> create(std::shared_ptr<NodeImpl> node, ErasedSubscription erased,
                                                  const std::string & topic, const QoS & qos);
  SubscriptionImpl(std::shared_ptr<NodeImpl> node, ErasedSubscription erased, const std::string & topic,
                   const QoS & qos);
  ~SubscriptionImpl() override;

  std::size_t get_publisher_count() const;
  const std::string & get_topic_name() const noexcept { return topic_; }

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  void warn_of_qos();

  const ErasedSubscription erased_;
  rcl_subscription_t subscription_;
  std::string topic_;
  std::unique_ptr<QosWarning> warning_;
  std::shared_ptr<void> message_;  // taken into again and again, unless a callback has kept it
};

}  // namespace rcl_cxx::detail
