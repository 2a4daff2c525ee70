#pragma once

#include <cstddef>
#include <memory>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <string>

#include "rcl_cxx/qos.hpp"

namespace rcl_cxx {
namespace detail {
class NodeImpl;
class PublisherImpl;
}  // namespace detail

/// A publisher without the type of its messages.
class PublisherBase {
 public:
  PublisherBase(std::shared_ptr<detail::NodeImpl> node, const rosidl_message_type_support_t * type_support,
                const std::string & topic, const QoS & qos);
  virtual ~PublisherBase();
  PublisherBase(const PublisherBase &) = delete;
  PublisherBase & operator=(const PublisherBase &) = delete;

  /// The resolved topic, "/robot/joint_states".
  const std::string & get_topic_name() const noexcept;
  /// The number of matched subscriptions; 0 after the shutdown.
  std::size_t get_subscription_count() const;

 protected:
  bool publish_message(const void * message) noexcept;

 private:
  std::shared_ptr<detail::PublisherImpl> impl_;
};

/// Created by Node::create_publisher. Thread-safe.
template <typename M>
class Publisher : public PublisherBase {
 public:
  using SharedPtr = std::shared_ptr<Publisher<M>>;

  Publisher(std::shared_ptr<detail::NodeImpl> node, const std::string & topic, const QoS & qos)
      : PublisherBase(std::move(node), rosidl_typesupport_cpp::get_message_type_support_handle<M>(), topic,
                      qos)
  {
  }

  /// Serializes and sends in the caller's thread; this layer does not allocate. Returns false if the message
  /// was not published. A failure is logged at most once a second per publisher; after the shutdown it is not
  /// logged. Never throws.
  bool publish(const M & message) noexcept { return publish_message(&message); }
};

}  // namespace rcl_cxx
