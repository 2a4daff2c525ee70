#pragma once

#include <rcl/event.h>
#include <rcl/event_callback.h>
#include <rmw/qos_string_conversions.h>

#include <optional>
#include <string>

#include "rcl_support/rcl_compat.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
/// The middleware's event that an endpoint has discovered a peer with an incompatible quality of service.
class IncompatibleQosEvent {
 public:
  /// A middleware without this event reports no incompatible peers.
  template <typename Init, typename Endpoint, typename Type, typename SetCallback>
  void start(Init init, const Endpoint & endpoint, Type type, SetCallback set_callback)
  {
    started_ = init(&event_, &endpoint, type) == RCL_RET_OK;
    if (started_) {
      set_callback(event_);
    } else {
      rcl_reset_error();
    }
  }

  void stop() noexcept
  {
    if (started_) {
      ignore_rcl(rcl_event_set_callback(&event_, nullptr, nullptr));
    }
  }

  /// To call before the endpoint is finalized.
  void fini() noexcept
  {
    if (started_) {
      ignore_rcl(rcl_event_fini(&event_));
    }
  }

  /// "durability", or nothing if there is no event to take.
  std::optional<std::string> take_policy()
  {
    rmw_offered_qos_incompatible_event_status_t status;
    if (!started_ || rcl_take_event(&event_, &status) != RCL_RET_OK) {
      rcl_reset_error();
      return std::nullopt;
    }
    const char * const name = rmw_qos_policy_kind_to_str(status.last_policy_kind);
    return name != nullptr ? name : "unknown";
  }

 private:
  rcl_event_t event_ = rcl_get_zero_initialized_event();
  bool started_ = false;
};

}  // namespace rcl_cxx::detail
