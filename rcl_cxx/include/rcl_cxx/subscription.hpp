#pragma once

#include <rmw/types.h>

#include <array>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <string>
#include <type_traits>

#include "rcl_cxx/callback_group.hpp"
#include "rcl_cxx/qos.hpp"

namespace rcl_cxx {
/// Equal for all messages of one publisher, different for any other publisher.
using PublisherId = std::array<std::uint8_t, RMW_GID_STORAGE_SIZE>;

/// What the middleware knows about a message.
struct MessageInfo {
  PublisherId publisher{};
  /// When it was published, by the clock of the publisher's host.
  std::chrono::sys_time<std::chrono::nanoseconds> published{};
  /// Of the publisher's messages, one more with each of them; unknown with some middlewares (CycloneDDS).
  std::optional<std::uint64_t> number;
};

namespace detail {
class NodeImpl;
class SubscriptionImpl;

struct ErasedSubscription {
  const rosidl_message_type_support_t * type_support;
  std::shared_ptr<void> (*make_message)();
  std::function<void(const std::shared_ptr<void> &, const MessageInfo &)> callback;
};
}  // namespace detail

/// A subscription without the type of its messages.
class SubscriptionBase {
 public:
  SubscriptionBase(std::shared_ptr<detail::NodeImpl> node, detail::ErasedSubscription erased,
                   const std::string & topic, const QoS & qos, CallbackGroup::SharedPtr group);
  /// Waits for a callback that is running in the executor's thread, unless it is called from there. No
  /// callback runs afterwards.
  virtual ~SubscriptionBase();
  SubscriptionBase(const SubscriptionBase &) = delete;
  SubscriptionBase & operator=(const SubscriptionBase &) = delete;

  const std::string & get_topic_name() const noexcept;

 protected:
  bool take(void * message);

 private:
  std::shared_ptr<detail::SubscriptionImpl> impl_;
};

/// Created by Node::create_subscription. The callback takes `const M &` (valid during the call; the message
/// is reused), `const M &, const MessageInfo &`, or `std::shared_ptr<const M>` (may be kept). It runs in the
/// executor's thread.
template <typename M>
class Subscription : public SubscriptionBase {
 public:
  using SharedPtr = std::shared_ptr<Subscription<M>>;

  template <typename F>
  Subscription(std::shared_ptr<detail::NodeImpl> node, const std::string & topic, const QoS & qos,
               F && callback, CallbackGroup::SharedPtr group = {})
      : SubscriptionBase(std::move(node),
                         {rosidl_typesupport_cpp::get_message_type_support_handle<M>(),
                          []() -> std::shared_ptr<void> { return std::make_shared<M>(); },
                          erase(std::forward<F>(callback))},
                         topic, qos, std::move(group))
  {
  }

  /// Takes the oldest message for which the callback has not been called, and does not call it. Works before
  /// the node has an executor. Returns false if there is no message. @throws Error
  bool take(M & message) { return SubscriptionBase::take(&message); }

 private:
  template <typename F>
  static std::function<void(const std::shared_ptr<void> &, const MessageInfo &)> erase(F && callback)
  {
    if constexpr (std::invocable<std::decay_t<F> &, const M &, const MessageInfo &>) {
      return [f = std::forward<F>(callback)](const std::shared_ptr<void> & message,
                                             const MessageInfo & info) mutable {
        f(*static_cast<const M *>(message.get()), info);
      };
    } else if constexpr (std::invocable<std::decay_t<F> &, const M &>) {
      return [f = std::forward<F>(callback)](const std::shared_ptr<void> & message,
                                             const MessageInfo &) mutable {
        f(*static_cast<const M *>(message.get()));
      };
    } else {
      static_assert(std::invocable<std::decay_t<F> &, std::shared_ptr<const M>>,
                    "the callback takes const M &, const M & and const MessageInfo &, or "
                    "std::shared_ptr<const M>");
      return [f = std::forward<F>(callback)](const std::shared_ptr<void> & message,
                                             const MessageInfo &) mutable {
        f(std::static_pointer_cast<const M>(message));
      };
    }
  }
};

}  // namespace rcl_cxx
