#include "rcl_cxx/node.hpp"

#include "action_client_impl.hpp"
#include "action_server_impl.hpp"
#include "arguments.hpp"
#include "client_impl.hpp"
#include "node_impl.hpp"
#include "ns_per_second.hpp"
#include "parameter_messages.hpp"
#include "parameter_services.hpp"
#include "parameters.hpp"
#include "publisher_impl.hpp"
#include "rcl_error.hpp"
#include "service_impl.hpp"
#include "sim_time.hpp"
#include "subscription_impl.hpp"
#include "timer_impl.hpp"
#include "type_description_service.hpp"

namespace rcl_cxx {
namespace {
std::map<std::string, ParameterValue> read_overrides(const detail::NodeImpl & node,
                                                     detail::ContextImpl & context,
                                                     const NodeOptions & options,
                                                     const rcl_arguments_t & arguments)
{
  std::map<std::string, ParameterValue> overrides;
  if (options.use_global_arguments) {
    detail::read_parameter_overrides(context.handle()->global_arguments, node.get_fully_qualified_name(),
                                     overrides);
  }
  detail::read_parameter_overrides(arguments, node.get_fully_qualified_name(), overrides);
  for (const Parameter & parameter : options.parameter_overrides) {
    overrides[parameter.name] = parameter.value;
  }
  return overrides;
}

/// Publishes each change of the node's parameters.
detail::Parameters::Observer parameter_event_publisher(
    const std::shared_ptr<detail::NodeImpl> & node,
    std::shared_ptr<Publisher<rcl_interfaces::msg::ParameterEvent>> publisher)
{
  return [weak = std::weak_ptr(node), publisher](const detail::ParameterChanges & changes) {
    const auto impl = weak.lock();
    if (!impl) {
      return;
    }
    rcl_interfaces::msg::ParameterEvent event = detail::to_message(changes);
    const std::int64_t now = impl->get_clock().now_ns();
    event.stamp.sec = static_cast<std::int32_t>(now / detail::kNsPerSecond);
    event.stamp.nanosec = static_cast<std::uint32_t>(now % detail::kNsPerSecond);
    event.node = impl->get_fully_qualified_name();
    publisher->publish(event);
  };
}
}  // namespace

/// What every node brings along. Destroyed before the node's impl.
struct Node::Standard {
  std::unique_ptr<detail::SimTime> sim_time;
  std::unique_ptr<detail::TypeDescriptionService> type_description;
  std::unique_ptr<detail::ParameterServices> parameter_services;
};

Node::Node(Context::SharedPtr context, const std::string & name, const std::string & node_namespace,
           const NodeOptions & options)
    : context_(std::move(context))
{
  const detail::ParsedArguments arguments(options.arguments);
  impl_ =
      std::make_shared<detail::NodeImpl>(context_->impl(), name, node_namespace, options, arguments.get());
  parameters_ = std::make_shared<detail::Parameters>(
      impl_->get_logger(), read_overrides(*impl_, *context_->impl(), options, arguments.get()));
  if (options.start_parameter_event_publisher) {
    auto publisher =
        create_publisher<rcl_interfaces::msg::ParameterEvent>("/parameter_events", QoS::parameters());
    parameters_->observe(parameter_event_publisher(impl_, std::move(publisher)));
  }
  standard_ = std::make_unique<Standard>();
  standard_->sim_time = std::make_unique<detail::SimTime>(*this, *parameters_);
  standard_->type_description = std::make_unique<detail::TypeDescriptionService>(impl_, *parameters_);
  if (options.automatically_declare_parameters_from_overrides) {
    parameters_->declare_all_overrides();
  }
  if (options.start_parameter_services) {
    standard_->parameter_services = std::make_unique<detail::ParameterServices>(*this, parameters_);
  }
}

Node::~Node()
{
  standard_.reset();
  parameters_->observe({});
}

const std::string & Node::get_name() const noexcept
{
  return impl_->get_name();
}
const std::string & Node::get_namespace() const noexcept
{
  return impl_->get_namespace();
}
const std::string & Node::get_fully_qualified_name() const noexcept
{
  return impl_->get_fully_qualified_name();
}
const Context::SharedPtr & Node::get_context() const noexcept
{
  return context_;
}
const Logger & Node::get_logger() const noexcept
{
  return impl_->get_logger();
}

builtin_interfaces::msg::Time Node::now() const
{
  const std::int64_t ns = now_ns();
  builtin_interfaces::msg::Time time;
  time.sec = static_cast<std::int32_t>(ns / detail::kNsPerSecond);
  time.nanosec = static_cast<std::uint32_t>(ns % detail::kNsPerSecond);
  return time;
}

std::int64_t Node::now_ns() const
{
  return impl_->get_clock().now_ns();
}

std::string Node::resolve_topic_name(const std::string & topic) const
{
  return impl_->resolve(topic, false);
}

std::string Node::resolve_service_name(const std::string & service) const
{
  return impl_->resolve(service, true);
}

std::shared_ptr<Timer> Node::create_wall_timer(std::chrono::nanoseconds period,
                                               std::function<void()> callback)
{
  auto timer = detail::TimerImpl::create(impl_, period, std::move(callback));
  timer->arm();
  return std::make_shared<Timer>(std::move(timer));
}

std::shared_ptr<detail::PublisherImpl> Node::make_publisher(
    const rosidl_message_type_support_t * type_support, const std::string & topic, const QoS & qos)
{
  return detail::PublisherImpl::create(impl_, type_support, topic, qos);
}

std::shared_ptr<detail::SubscriptionImpl> Node::make_subscription(detail::ErasedSubscription erased,
                                                                  const std::string & topic, const QoS & qos)
{
  return detail::SubscriptionImpl::create(impl_, std::move(erased), topic, qos);
}

std::shared_ptr<detail::ServiceImpl> Node::make_service(detail::ErasedService erased,
                                                        const std::string & service, const QoS & qos)
{
  return detail::ServiceImpl::create(impl_, std::move(erased), service, qos);
}

std::shared_ptr<detail::ClientImpl> Node::make_client(detail::ErasedClient erased,
                                                      const std::string & service, const QoS & qos)
{
  return detail::ClientImpl::create(impl_, erased, service, qos);
}

std::shared_ptr<detail::ActionServerImpl> Node::make_action_server(detail::ErasedActionServer erased,
                                                                   const std::string & action,
                                                                   const ActionServerOptions & options)
{
  return detail::ActionServerImpl::create(impl_, std::move(erased), action, options);
}

std::shared_ptr<detail::ActionClientImpl> Node::make_action_client(const detail::ActionClientOps * ops,
                                                                   const std::string & action,
                                                                   const ActionClientOptions & options)
{
  return detail::ActionClientImpl::create(impl_, *ops, action, options);
}

ParameterValue Node::declare_parameter(const std::string & parameter, const ParameterValue & default_value,
                                       const ParameterDescriptor & options)
{
  return parameters_->declare(parameter, default_value, options);
}

void Node::undeclare_parameter(const std::string & parameter)
{
  parameters_->undeclare(parameter);
}

bool Node::has_parameter(const std::string & parameter) const
{
  return parameters_->has(parameter);
}

ParameterValue Node::get_parameter(const std::string & parameter) const
{
  return parameters_->get(parameter).value;
}

std::vector<Parameter> Node::get_parameters() const
{
  return parameters_->all();
}

SetParametersResult Node::set_parameter(const std::string & parameter, const ParameterValue & value)
{
  return parameters_->set({Parameter{parameter, value}});
}

SetParametersResult Node::set_parameters_atomically(const std::vector<Parameter> & parameters)
{
  return parameters_->set(parameters);
}

ParameterCallbackHandle Node::add_on_set_parameters_callback(OnSetParametersCallback callback)
{
  return parameters_->add_on_set(std::move(callback));
}

ParameterCallbackHandle Node::add_post_set_parameters_callback(PostSetParametersCallback callback)
{
  return parameters_->add_after_set(std::move(callback));
}

}  // namespace rcl_cxx
