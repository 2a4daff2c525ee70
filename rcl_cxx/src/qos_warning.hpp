#pragma once

#include <rcl/event.h>
#include <rcl/event_callback.h>

#include <string>

namespace rcl_cxx::detail {
/// The middleware's event that an endpoint found a partner whose quality of service does not fit.
class QosWarning {
 public:
  QosWarning() = default;
  ~QosWarning();
  QosWarning(const QosWarning &) = delete;
  QosWarning & operator=(const QosWarning &) = delete;

  void start(const rcl_publisher_t & publisher, rcl_event_callback_t callback, const void * source);
  void start(const rcl_subscription_t & subscription, rcl_event_callback_t callback, const void * source);
  void stop() noexcept;

  /// "durability", or nothing if there is no event to take.
  std::string take_policy();

 private:
  void start_if(rcl_ret_t initialised, rcl_event_callback_t callback, const void * source);

  rcl_event_t event_ = rcl_get_zero_initialized_event();
  bool started_ = false;
};

}  // namespace rcl_cxx::detail
