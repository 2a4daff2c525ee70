#pragma once

#include <cstddef>
#include <memory>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <string>

namespace rcl_cxx {
namespace detail {
class PublisherImpl;
}

class PublisherBase {
 public:
  virtual ~PublisherBase();
  PublisherBase(const PublisherBase &) = delete;
  PublisherBase & operator=(const PublisherBase &) = delete;

  /// The resolved topic, "/robot/joint_states".
  const std::string & get_topic_name() const noexcept;
  /// Matched subscriptions.
  std::size_t get_subscription_count() const;

 protected:
  explicit PublisherBase(std::shared_ptr<detail::PublisherImpl> impl);
  bool publish_message(const void * message) noexcept;

 private:
  std::shared_ptr<detail::PublisherImpl> impl_;
};

/// From Node::create_publisher. Thread-safe; may outlive the node object, not its context's shutdown
/// (publishing is then a no-op).
template <typename M>
class Publisher : public PublisherBase {
 public:
  using SharedPtr = std::shared_ptr<Publisher<M>>;

  explicit Publisher(std::shared_ptr<detail::PublisherImpl> impl) : PublisherBase(std::move(impl)) {}

  /// Serialises and sends in the caller's thread; this layer allocates nothing. Returns false if the message
  /// was not published. A failure is logged, at most once a second for each publisher; it is no reason to end
  /// what publishes.
  bool publish(const M & message) noexcept { return publish_message(&message); }
};

}  // namespace rcl_cxx
