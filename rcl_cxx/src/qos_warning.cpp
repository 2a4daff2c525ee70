#include "qos_warning.hpp"

#include <rmw/qos_string_conversions.h>

#include "rcl_compat.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx::detail {
QosWarning::~QosWarning()
{
  if (started_) {
    ignore_rcl(rcl_event_fini(&event_));
  }
}

void QosWarning::start(const rcl_publisher_t & publisher, rcl_event_callback_t callback, const void * source)
{
  start_if(rcl_publisher_event_init(&event_, &publisher, RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS), callback,
           source);
}

void QosWarning::start(const rcl_subscription_t & subscription, rcl_event_callback_t callback,
                       const void * source)
{
  start_if(rcl_subscription_event_init(&event_, &subscription, RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS),
           callback, source);
}

void QosWarning::start_if(rcl_ret_t initialised, rcl_event_callback_t callback, const void * source)
{
  // A middleware need not offer the event; then there are no warnings.
  started_ = initialised == RCL_RET_OK;
  if (started_) {
    ignore_rcl(rcl_event_set_callback(&event_, callback, source));
  } else {
    rcl_reset_error();
  }
}

void QosWarning::stop() noexcept
{
  if (started_) {
    ignore_rcl(rcl_event_set_callback(&event_, nullptr, nullptr));
  }
}

std::string QosWarning::take_policy()
{
  rmw_offered_qos_incompatible_event_status_t status;
  if (!started_ || rcl_take_event(&event_, &status) != RCL_RET_OK) {
    rcl_reset_error();
    return {};
  }
  const char * const name = rmw_qos_policy_kind_to_str(status.last_policy_kind);
  return name != nullptr ? name : "unknown";
}

}  // namespace rcl_cxx::detail
