#include "rcl_cxx/node.hpp"

#include <rcl_interfaces/msg/parameter_event.hpp>

#include "node/node_impl.hpp"
#include "node/sim_time.hpp"
#include "parameters/parameter_messages.hpp"
#include "parameters/parameter_services.hpp"
#include "parameters/parameters.hpp"
#include "rcl_support/to_time.hpp"

namespace rcl_cxx {
namespace {
using ParameterEvent = rcl_interfaces::msg::ParameterEvent;

/// Publishes every change of the node's parameters.
detail::Parameters::OnChange publish_parameter_events(const std::shared_ptr<detail::NodeImpl> & node,
                                                      std::shared_ptr<Publisher<ParameterEvent>> publisher)
{
  return [weak = std::weak_ptr(node), publisher](const detail::ParameterChanges & changes) {
    if (const auto impl = weak.lock()) {
      ParameterEvent event = detail::to_message(changes);
      event.stamp = detail::to_time(impl->get_clock().now_ns());
      event.node = impl->get_fully_qualified_name();
      publisher->publish(event);
    }
  };
}
}  // namespace

/// What every node has. Destroyed before the node's impl.
struct Node::Standard {
  std::unique_ptr<detail::SimTime> sim_time;
  std::unique_ptr<detail::ParameterServices> parameter_services;
};

Node::Node(Context::SharedPtr context, const std::string & name, const std::string & node_namespace)
    : context_(std::move(context)),
      impl_(std::make_shared<detail::NodeImpl>(context_->impl(), name, node_namespace)),
      parameters_(std::make_shared<detail::Parameters>(impl_->read_parameter_overrides())),
      standard_(std::make_unique<Standard>())
{
  parameters_->add_on_change(publish_parameter_events(
      impl_, create_publisher<ParameterEvent>("/parameter_events", QoS::parameters())));
  standard_->sim_time = std::make_unique<detail::SimTime>(*this, *parameters_);
  standard_->parameter_services = std::make_unique<detail::ParameterServices>(*this, parameters_);
}

Node::~Node()
{
  parameters_->remove_on_change();
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
  return detail::to_time(impl_->get_clock().now_ns());
}

std::string Node::resolve_topic_name(const std::string & topic) const
{
  return impl_->resolve(topic, false);
}

ActionServer::SharedPtr Node::create_action_server(const ActionType & type, const std::string & action,
                                                   ActionServerCallbacks callbacks,
                                                   const ActionServerOptions & options)
{
  return std::make_shared<ActionServer>(impl_, type, action, std::move(callbacks), options);
}

std::string Node::resolve_service_name(const std::string & service) const
{
  return impl_->resolve(service, true);
}

ParameterValue Node::declare_parameter(const std::string & parameter, const ParameterValue & default_value,
                                       const ParameterDescriptor & descriptor)
{
  return parameters_->declare(parameter, default_value, descriptor);
}

bool Node::has_parameter(const std::string & parameter) const
{
  return parameters_->has(parameter);
}

ParameterValue Node::get_parameter(const std::string & parameter) const
{
  return parameters_->get(parameter).value;
}

std::vector<std::string> Node::list_parameters() const
{
  std::vector<std::string> names;
  for (const Parameter & parameter : parameters_->all()) {
    names.push_back(parameter.name);
  }
  return names;
}

std::vector<std::string> Node::undeclared_overrides() const
{
  return parameters_->undeclared_overrides();
}

SetParametersResult Node::set_parameter(const std::string & parameter, const ParameterValue & value)
{
  return parameters_->set({Parameter{parameter, value}});
}

}  // namespace rcl_cxx
