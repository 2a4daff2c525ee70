#pragma once

#include <builtin_interfaces/msg/time.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rcl_cxx/action_server.hpp"
#include "rcl_cxx/callback_group.hpp"
#include "rcl_cxx/context.hpp"
#include "rcl_cxx/error.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/parameter.hpp"
#include "rcl_cxx/publisher.hpp"
#include "rcl_cxx/qos.hpp"
#include "rcl_cxx/service.hpp"
#include "rcl_cxx/subscription.hpp"
#include "rcl_cxx/timer.hpp"

namespace rcl_cxx {
namespace detail {
class NodeImpl;
class Parameters;
}  // namespace detail

/// A ROS node. It offers what a node of rclcpp offers: the parameter use_sim_time, the six parameter
/// services, /parameter_events and /rosout.
///
/// Topic, service and action names are relative unless they begin with '/'; '~/x' is private to the node;
/// remaps apply. All members are thread-safe. Publishers, subscriptions, services, timers and action servers
/// may outlive the node object. Their callbacks run once the node has been added to an executor; events that
/// arrive earlier are kept.
class Node {
 public:
  using SharedPtr = std::shared_ptr<Node>;

  /// @throws Error for an invalid name or namespace.
  Node(Context::SharedPtr context, const std::string & name, const std::string & node_namespace = "");
  ~Node();
  Node(const Node &) = delete;
  Node & operator=(const Node &) = delete;

  const std::string & get_name() const noexcept;
  const std::string & get_namespace() const noexcept;  ///< "/", "/robot"
  const std::string & get_fully_qualified_name() const noexcept;
  const Context::SharedPtr & get_context() const noexcept;
  const Logger & get_logger() const noexcept;

  /// ROS time: the system's, or /clock's if use_sim_time is set.
  builtin_interfaces::msg::Time now() const;

  /// Expanded and remapped. @throws Error for an invalid name
  std::string resolve_topic_name(const std::string & name) const;
  std::string resolve_service_name(const std::string & name) const;

  template <typename M>
  std::shared_ptr<Publisher<M>> create_publisher(const std::string & topic, const QoS & qos)
  {
    return std::make_shared<Publisher<M>>(impl_, topic, qos);
  }

  /// `callback` takes const M & or std::shared_ptr<const M>. It runs in `group`; default: that of the node.
  template <typename M, typename F>
  std::shared_ptr<Subscription<M>> create_subscription(const std::string & topic, const QoS & qos,
                                                       F && callback, CallbackGroup::SharedPtr group = {})
  {
    return std::make_shared<Subscription<M>>(impl_, topic, qos, std::forward<F>(callback), std::move(group));
  }

  /// `callback` is called as callback(const S::Request &, S::Response &), in `group`; default: that of the
  /// node.
  template <typename S, typename F>
  std::shared_ptr<Service<S>> create_service(const std::string & service, F && callback,
                                             const QoS & qos = QoS::services_default(),
                                             CallbackGroup::SharedPtr group = {})
  {
    return std::make_shared<Service<S>>(impl_, std::forward<F>(callback), service, qos, std::move(group));
  }

  /// A group for callbacks that must not wait for those of this node; see CallbackGroup.
  CallbackGroup::SharedPtr create_callback_group() { return std::make_shared<CallbackGroup>(); }

  /// The first call is one period from now. `callback` runs in `group`; default: that of the node. @throws
  /// Error for a period <= 0.
  std::shared_ptr<Timer> create_wall_timer(std::chrono::nanoseconds period, std::function<void()> callback,
                                           CallbackGroup::SharedPtr group = {})
  {
    return std::make_shared<Timer>(impl_, period, std::move(callback), std::move(group));
  }

  template <typename A>
  ActionServer::SharedPtr create_action_server(const std::string & action, ActionServerCallbacks callbacks,
                                               const ActionServerOptions & options = {})
  {
    return create_action_server(action_type<A>(), action, std::move(callbacks), options);
  }
  ActionServer::SharedPtr create_action_server(const ActionType & type, const std::string & action,
                                               ActionServerCallbacks callbacks,
                                               const ActionServerOptions & options = {});

  /// Declares a parameter and returns its value: that of the command line or parameter file, else the
  /// default. An integer override of a floating-point parameter is converted.
  /// @throws ParameterError if it is declared already, or a value has the wrong type or is out of range.
  template <typename T>
  T declare_parameter(const std::string & parameter, const T & default_value,
                      const ParameterDescriptor & descriptor = {})
  {
    return declare_parameter(parameter, ParameterValue(default_value), descriptor).template get<T>();
  }
  std::string declare_parameter(const std::string & parameter, const char * default_value,
                                const ParameterDescriptor & descriptor = {})
  {
    return declare_parameter<std::string>(parameter, default_value, descriptor);
  }
  ParameterValue declare_parameter(const std::string & parameter, const ParameterValue & default_value,
                                   const ParameterDescriptor & descriptor = {});

  bool has_parameter(const std::string & parameter) const;
  /// @throws ParameterError if not declared
  ParameterValue get_parameter(const std::string & parameter) const;
  /// @throws ParameterError if not declared, Error if of another type
  template <typename T>
  T get_parameter(const std::string & parameter) const
  {
    return get_parameter(parameter).template get<T>();
  }
  /// Names of all declared parameters.
  std::vector<std::string> list_parameters() const;
  /// Names that the command line or a parameter file sets for this node, and that are not declared.
  std::vector<std::string> undeclared_overrides() const;
  /// The error names the parameter and its limits.
  SetParametersResult set_parameter(const std::string & parameter, const ParameterValue & value);

  const std::shared_ptr<detail::NodeImpl> & impl() const noexcept { return impl_; }

 private:
  struct Standard;

  Context::SharedPtr context_;
  std::shared_ptr<detail::NodeImpl> impl_;
  std::shared_ptr<detail::Parameters> parameters_;
  std::unique_ptr<Standard> standard_;
};

}  // namespace rcl_cxx
