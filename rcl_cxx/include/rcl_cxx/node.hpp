#pragma once

#include <builtin_interfaces/msg/time.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rcl_cxx/action_client.hpp"
#include "rcl_cxx/action_server.hpp"
#include "rcl_cxx/client.hpp"
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

struct NodeOptions {
  /// As if given on the command line, only for this node, and winning over it: {"--ros-args", "-r", "a:=b"}.
  std::vector<std::string> arguments{};
  /// Take remaps and parameters of the context's command line.
  bool use_global_arguments = true;
  /// Win over command line and parameter files.
  std::vector<Parameter> parameter_overrides{};
  /// Declare whatever command line and parameter files set for this node.
  bool automatically_declare_parameters_from_overrides = false;
  bool start_parameter_services = true;
  bool start_parameter_event_publisher = true;
  bool enable_rosout = true;
};

/// A ROS node: seen from outside it is one of rclcpp's, with the parameters use_sim_time and (where rcl
/// offers it) start_type_description_service, six parameter services, /parameter_events and /rosout.
///
/// Names are relative unless they begin with '/'; '~/x' is private; remaps apply. All members are
/// thread-safe. The entities it creates work once the node has been added to an executor; what arrives before
/// is kept for it. They may outlive this object.
class Node {
 public:
  using SharedPtr = std::shared_ptr<Node>;

  /// @throws Error for an invalid name or namespace, a bad argument or parameter file.
  Node(Context::SharedPtr context, const std::string & name, const std::string & node_namespace = "",
       const NodeOptions & options = {});
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
  std::int64_t now_ns() const;

  /// Expanded and remapped. @throws Error for an invalid name
  std::string resolve_topic_name(const std::string & name) const;
  std::string resolve_service_name(const std::string & name) const;

  template <typename M>
  std::shared_ptr<Publisher<M>> create_publisher(const std::string & topic, const QoS & qos)
  {
    return std::make_shared<Publisher<M>>(
        make_publisher(rosidl_typesupport_cpp::get_message_type_support_handle<M>(), topic, qos));
  }

  /// `callback` takes const M & or std::shared_ptr<const M>.
  template <typename M, typename F>
  std::shared_ptr<Subscription<M>> create_subscription(const std::string & topic, const QoS & qos,
                                                       F && callback)
  {
    return std::make_shared<Subscription<M>>(
        make_subscription(Subscription<M>::erase(std::forward<F>(callback)), topic, qos));
  }

  /// `callback` is called as callback(const S::Request &, S::Response &).
  template <typename S, typename F>
  std::shared_ptr<Service<S>> create_service(const std::string & service, F && callback,
                                             const QoS & qos = QoS::services_default())
  {
    return std::make_shared<Service<S>>(
        make_service(Service<S>::erase(std::forward<F>(callback)), service, qos));
  }

  template <typename S>
  std::shared_ptr<Client<S>> create_client(const std::string & service,
                                           const QoS & qos = QoS::services_default())
  {
    return std::make_shared<Client<S>>(make_client(erase_client<S>(), service, qos));
  }

  /// First call one period from now. @throws Error for a period <= 0.
  std::shared_ptr<Timer> create_wall_timer(std::chrono::nanoseconds period, std::function<void()> callback);

  /// @throws Error without handlers.handle_accepted
  template <typename A>
  std::shared_ptr<ActionServer<A>> create_action_server(const std::string & action,
                                                        ActionServerCallbacks<A> handlers,
                                                        const ActionServerOptions & options = {})
  {
    return std::make_shared<ActionServer<A>>(
        make_action_server(ActionServer<A>::erase(std::move(handlers)), action, options));
  }

  template <typename A>
  std::shared_ptr<ActionClient<A>> create_action_client(const std::string & action,
                                                        const ActionClientOptions & options = {})
  {
    return std::make_shared<ActionClient<A>>(
        make_action_client(&detail::ActionClientOpsOf<A>::ops, action, options));
  }

  /// Declares, and returns the value: the override of NodeOptions, command line or parameter file, else the
  /// default. An integer override of a floating-point parameter is taken as such a number.
  /// @throws ParameterError if declared already, or a value does not suit type, range or a callback.
  template <typename T>
  T declare_parameter(const std::string & parameter, const T & default_value,
                      const ParameterDescriptor & options = {})
  {
    return declare_parameter(parameter, ParameterValue(default_value), options).template get<T>();
  }
  std::string declare_parameter(const std::string & parameter, const char * default_value,
                                const ParameterDescriptor & options = {})
  {
    return declare_parameter<std::string>(parameter, default_value, options);
  }
  /// The type is that of `default_value`, or with dynamic_typing whatever it gets.
  ParameterValue declare_parameter(const std::string & parameter, const ParameterValue & default_value,
                                   const ParameterDescriptor & options = {});
  /// @throws ParameterError if not declared, or read-only, or statically typed (as rclcpp)
  void undeclare_parameter(const std::string & parameter);

  bool has_parameter(const std::string & parameter) const;
  /// @throws ParameterError if not declared
  ParameterValue get_parameter(const std::string & parameter) const;
  /// @throws ParameterError if not declared, Error if of another type
  template <typename T>
  T get_parameter(const std::string & parameter) const
  {
    return get_parameter(parameter).template get<T>();
  }
  /// All declared ones, sorted by name.
  std::vector<Parameter> get_parameters() const;

  /// The reason of a refusal names the parameter and what it may be.
  SetParametersResult set_parameter(const std::string & parameter, const ParameterValue & value);
  /// All or nothing.
  SetParametersResult set_parameters_atomically(const std::vector<Parameter> & parameters);

  /// May refuse a change (also a first value at declaration). Asked in order, latest registered first.
  [[nodiscard]] ParameterCallbackHandle add_on_set_parameters_callback(OnSetParametersCallback callback);
  /// Told after a change took effect.
  [[nodiscard]] ParameterCallbackHandle add_post_set_parameters_callback(PostSetParametersCallback callback);

  /// Graph queries; names are resolved first.
  std::size_t count_publishers(const std::string & topic) const;
  std::size_t count_subscribers(const std::string & topic) const;
  /// Fully qualified names of all nodes that are known here.
  std::vector<std::string> get_node_names() const;
  using NamesAndTypes = std::map<std::string, std::vector<std::string>>;
  NamesAndTypes get_topic_names_and_types() const;
  NamesAndTypes get_service_names_and_types() const;

  /// Wait for at least `count`; false on timeout or shutdown. Not for callbacks of the executor.
  bool wait_for_publishers(const std::string & topic, std::size_t count,
                           std::chrono::nanoseconds timeout) const;
  bool wait_for_subscribers(const std::string & topic, std::size_t count,
                            std::chrono::nanoseconds timeout) const;
  bool wait_for_node(const std::string & fully_qualified_name, std::chrono::nanoseconds timeout) const;

  const std::shared_ptr<detail::NodeImpl> & impl() const noexcept { return impl_; }

 private:
  std::shared_ptr<detail::PublisherImpl> make_publisher(const rosidl_message_type_support_t *,
                                                        const std::string & topic, const QoS &);
  std::shared_ptr<detail::SubscriptionImpl> make_subscription(detail::ErasedSubscription,
                                                              const std::string & topic, const QoS &);
  std::shared_ptr<detail::ServiceImpl> make_service(detail::ErasedService, const std::string & service,
                                                    const QoS &);
  std::shared_ptr<detail::ClientImpl> make_client(detail::ErasedClient, const std::string & service,
                                                  const QoS &);
  std::shared_ptr<detail::ActionServerImpl> make_action_server(detail::ErasedActionServer,
                                                               const std::string & action,
                                                               const ActionServerOptions &);
  std::shared_ptr<detail::ActionClientImpl> make_action_client(const detail::ActionClientOps *,
                                                               const std::string & action,
                                                               const ActionClientOptions &);

  struct Standard;

  Context::SharedPtr context_;
  std::shared_ptr<detail::NodeImpl> impl_;
  std::shared_ptr<detail::Parameters> parameters_;
  std::unique_ptr<Standard> standard_;
};

}  // namespace rcl_cxx
