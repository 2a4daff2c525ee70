#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <string>
#include <type_traits>

namespace rcl_cxx {
namespace detail {
class SubscriptionImpl;

struct ErasedSubscription {
  const rosidl_message_type_support_t * type_support;
  std::shared_ptr<void> (*make_message)();
  std::function<void(const std::shared_ptr<void> &)> callback;
};
}  // namespace detail

class SubscriptionBase {
 public:
  /// No callback runs once this has returned: it waits for one that is running in the executor's thread,
  /// unless it is called from there.
  virtual ~SubscriptionBase();
  SubscriptionBase(const SubscriptionBase &) = delete;
  SubscriptionBase & operator=(const SubscriptionBase &) = delete;

  const std::string & get_topic_name() const noexcept;
  /// Matched publishers.
  std::size_t get_publisher_count() const;

 protected:
  explicit SubscriptionBase(std::shared_ptr<detail::SubscriptionImpl> impl);

 private:
  std::shared_ptr<detail::SubscriptionImpl> impl_;
};

/// From Node::create_subscription. The callback takes `const M &` (valid during the call; the message is
/// reused) or `std::shared_ptr<const M>` (to keep), and runs in the thread of the executor that the node was
/// added to.
template <typename M>
class Subscription : public SubscriptionBase {
 public:
  using SharedPtr = std::shared_ptr<Subscription<M>>;

  explicit Subscription(std::shared_ptr<detail::SubscriptionImpl> impl) : SubscriptionBase(std::move(impl)) {}

  template <typename F>
  static detail::ErasedSubscription erase(F && callback)
  {
    detail::ErasedSubscription erased{rosidl_typesupport_cpp::get_message_type_support_handle<M>(),
                                      []() -> std::shared_ptr<void> { return std::make_shared<M>(); },
                                      {}};
    if constexpr (std::invocable<std::decay_t<F> &, const M &>) {
      erased.callback = [f = std::forward<F>(callback)](const std::shared_ptr<void> & message) mutable {
        f(*static_cast<const M *>(message.get()));
      };
    } else {
      static_assert(std::invocable<std::decay_t<F> &, std::shared_ptr<const M>>,
                    "the callback takes const M & or std::shared_ptr<const M>");
      erased.callback = [f = std::forward<F>(callback)](const std::shared_ptr<void> & message) mutable {
        f(std::static_pointer_cast<const M>(message));
      };
    }
    return erased;
  }
};

}  // namespace rcl_cxx
