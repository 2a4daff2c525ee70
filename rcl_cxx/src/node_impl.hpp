#pragma once

#include <rcl/node.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "context_impl.hpp"
#include "pending_events.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/node.hpp"
#include "ros_clock.hpp"

namespace rcl_cxx::detail {
/// Owns the rcl node, and lives as long as any of its entities.
class NodeImpl {
 public:
  NodeImpl(std::shared_ptr<ContextImpl> context, const std::string & name, const std::string & node_namespace,
           const NodeOptions & options, const rcl_arguments_t & arguments);
  ~NodeImpl();
  NodeImpl(const NodeImpl &) = delete;
  NodeImpl & operator=(const NodeImpl &) = delete;

  rcl_node_t * handle() noexcept { return &node_; }
  /// To hold while an rcl entity of this node is initialised or finalised: rcl does not guard the node's own
  /// tables.
  std::mutex & mutex() noexcept { return mutex_; }
  PendingEvents & pending_events() noexcept { return pending_events_; }
  RosClock & get_clock() noexcept { return clock_; }
  ContextImpl & get_context() noexcept { return *context_impl_; }

  const Logger & get_logger() const noexcept { return logger_; }
  const std::string & get_name() const noexcept { return name_; }
  const std::string & get_namespace() const noexcept { return namespace_; }
  const std::string & get_fully_qualified_name() const noexcept { return fully_qualified_name_; }

  /// Expanded and remapped. @throws Error
  std::string resolve(const std::string & name, bool is_service) const;

  /// True in a callback of the executor that serves this node: waiting for another callback would be for
  /// ever.
  bool in_own_callback() const;
  /// Looks at `condition` every few milliseconds. False at the deadline or on shutdown.
  bool wait_for(const std::function<bool()> & condition, std::chrono::nanoseconds timeout) const;
  /// Why an answer may have failed to come; empty if there is nothing to say.
  std::string executor_hint() const;

 private:
  void start_rosout();
  void end_rosout();

  const std::shared_ptr<ContextImpl> context_impl_;
  mutable std::mutex mutex_;
  rcl_node_t node_;
  bool has_rosout_ = false;  ///< guarded by logging_mutex
  std::size_t rosout_end_ = 0;
  Logger logger_;
  std::string name_;
  std::string namespace_;
  std::string fully_qualified_name_;
  RosClock clock_;
  PendingEvents pending_events_;
};

}  // namespace rcl_cxx::detail
