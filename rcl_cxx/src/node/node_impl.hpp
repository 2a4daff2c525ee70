#pragma once

#include <rcl/node.h>

#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>

#include "context/context_impl.hpp"
#include "node/ros_clock.hpp"
#include "rcl_cxx/callback_group.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/parameter.hpp"

namespace rcl_cxx::detail {
/// Owns the rcl node. Lives as long as any part of the node.
class NodeImpl {
 public:
  NodeImpl(std::shared_ptr<ContextImpl> context, const std::string & name,
           const std::string & node_namespace);
  ~NodeImpl();
  NodeImpl(const NodeImpl &) = delete;
  NodeImpl & operator=(const NodeImpl &) = delete;

  rcl_node_t * handle() noexcept { return &node_; }
  /// To hold while an rcl entity of this node is initialized or finalized: rcl does not guard the node's
  /// tables.
  std::mutex & mutex() noexcept { return mutex_; }
  struct CreationLock {
    std::unique_lock<std::mutex> node;
    std::shared_lock<std::shared_mutex> context;
  };
  /// To hold while the entity `label` is initialized: locks mutex(), and rcl is not shut down in the
  /// meantime.
  /// @throws Error during and after a shutdown
  CreationLock lock_to_create(const std::string & label);
  const CallbackGroup::SharedPtr & default_group() const noexcept { return default_group_; }
  RosClock & get_clock() noexcept { return clock_; }
  ContextImpl & get_context() noexcept { return *context_impl_; }

  const Logger & get_logger() const noexcept { return logger_; }
  const std::string & get_name() const noexcept { return name_; }
  const std::string & get_namespace() const noexcept { return namespace_; }
  const std::string & get_fully_qualified_name() const noexcept { return fully_qualified_name_; }

  /// Expands and remaps a name. @throws Error if it is invalid
  std::string resolve(const std::string & name, bool is_service) const;
  /// The values for this node from the command line and parameter files.
  std::map<std::string, ParameterValue> read_parameter_overrides() const;

 private:
  void end_rosout();

  const std::shared_ptr<ContextImpl> context_impl_;
  mutable std::mutex mutex_;
  rcl_node_t node_ = rcl_get_zero_initialized_node();
  bool has_rosout_ = false;  ///< guarded by logging_mutex
  std::size_t rosout_end_ = 0;
  Logger logger_;
  std::string name_;
  std::string namespace_;
  std::string fully_qualified_name_;
  RosClock clock_;
  const CallbackGroup::SharedPtr default_group_ = std::make_shared<CallbackGroup>();
};

}  // namespace rcl_cxx::detail
