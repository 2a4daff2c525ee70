#pragma once

#include <rcl/event.h>
#include <rcl/publisher.h>

#include <memory>
#include <string>

#include "executor/waitable.hpp"
#include "rcl_cxx/action_server.hpp"
#include "rcl_support/type_support.hpp"

namespace rcl_cxx::detail {
class ActionServerImpl;

/// An action whose server is created when the first client appears: a publisher of its feedback, which never
/// publishes. ROS lists actions by this topic, and a client subscribes to it.
///
/// The server stays: while its endpoints are removed, a client that still finds them would lose a request.
/// The publisher stays, too: it costs 21 KB, and Fast DDS 3 may lose the announcement of its removal
/// (docs/internals/discovery.md).
class ActionAnnouncement : public Waitable {
 public:
  ActionAnnouncement(std::shared_ptr<NodeImpl> node, const ActionType & type, const std::string & name,
                     ActionServerCallbacks callbacks, const ActionServerOptions & options);
  ~ActionAnnouncement() override;

  void set_on_ready_callbacks() override;
  /// Retires the server, if there is one, and creates none afterwards.
  void retire() noexcept;

 protected:
  /// A client has appeared.
  void execute(std::size_t source) override;
  const CallbackGroup & group(std::size_t source) const override;
  void clear_on_ready_callbacks() noexcept override;

 private:
  void create_server();

  const ActionType & type_;
  const std::string name_;
  const ActionServerCallbacks callbacks_;
  const ActionServerOptions options_;
  const MessageTypeSupport type_support_;  ///< of the feedback
  rcl_publisher_t publisher_ = rcl_get_zero_initialized_publisher();
  rcl_event_t matched_ = rcl_get_zero_initialized_event();
  bool reports_clients_ = false;
  std::shared_ptr<ActionServerImpl> server_;
};

}  // namespace rcl_cxx::detail
