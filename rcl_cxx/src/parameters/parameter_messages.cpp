#include "parameters/parameter_messages.hpp"

namespace rcl_cxx::detail {
namespace {
struct Fill {
  rcl_interfaces::msg::ParameterValue & message;

  void operator()(std::monostate) const {}
  void operator()(bool value) const { message.bool_value = value; }
  void operator()(std::int64_t value) const { message.integer_value = value; }
  void operator()(double value) const { message.double_value = value; }
  void operator()(const std::string & value) const { message.string_value = value; }
  void operator()(const std::vector<std::uint8_t> & value) const { message.byte_array_value = value; }
  void operator()(const std::vector<bool> & value) const { message.bool_array_value = value; }
  void operator()(const std::vector<std::int64_t> & value) const { message.integer_array_value = value; }
  void operator()(const std::vector<double> & value) const { message.double_array_value = value; }
  void operator()(const std::vector<std::string> & value) const { message.string_array_value = value; }
};

std::vector<rcl_interfaces::msg::Parameter> to_messages(const std::vector<Parameter> & parameters)
{
  std::vector<rcl_interfaces::msg::Parameter> messages;
  for (const Parameter & parameter : parameters) {
    messages.push_back(to_message(parameter));
  }
  return messages;
}

template <typename Range, typename Messages>
void add_range(const std::optional<Range> & range, Messages & messages)
{
  if (range) {
    typename Messages::value_type message;  // emplace_back of Humble's bounded vectors returns a copy
    message.from_value = range->from_value;
    message.to_value = range->to_value;
    message.step = range->step;
    messages.push_back(message);
  }
}
}  // namespace

rcl_interfaces::msg::ParameterValue to_message(const ParameterValue & value)
{
  rcl_interfaces::msg::ParameterValue message;
  message.type = static_cast<std::uint8_t>(value.get_type());
  std::visit(Fill{message}, value.variant());
  return message;
}

ParameterValue from_message(const rcl_interfaces::msg::ParameterValue & message)
{
  switch (static_cast<ParameterType>(message.type)) {
    case ParameterType::not_set:
      break;
    case ParameterType::boolean:
      return message.bool_value;
    case ParameterType::integer:
      return message.integer_value;
    case ParameterType::floating_point:
      return message.double_value;
    case ParameterType::string:
      return message.string_value;
    case ParameterType::byte_array:
      return message.byte_array_value;
    case ParameterType::boolean_array:
      return message.bool_array_value;
    case ParameterType::integer_array:
      return message.integer_array_value;
    case ParameterType::floating_point_array:
      return message.double_array_value;
    case ParameterType::string_array:
      return message.string_array_value;
  }
  return {};
}

rcl_interfaces::msg::Parameter to_message(const Parameter & parameter)
{
  rcl_interfaces::msg::Parameter message;
  message.name = parameter.name;
  message.value = to_message(parameter.value);
  return message;
}

Parameter from_message(const rcl_interfaces::msg::Parameter & message)
{
  return {message.name, from_message(message.value)};
}

rcl_interfaces::msg::ParameterDescriptor to_message(const std::string & name, const Parameters::Entry & entry)
{
  rcl_interfaces::msg::ParameterDescriptor message;
  message.name = name;
  message.type = static_cast<std::uint8_t>(entry.value.get_type());
  message.description = entry.descriptor.description;
  message.additional_constraints = entry.descriptor.additional_constraints;
  message.read_only = entry.descriptor.read_only;
  add_range(entry.descriptor.floating_point_range, message.floating_point_range);
  add_range(entry.descriptor.integer_range, message.integer_range);
  return message;
}

rcl_interfaces::msg::ParameterEvent to_message(const ParameterChanges & changes)
{
  rcl_interfaces::msg::ParameterEvent message;
  message.new_parameters = to_messages(changes.added);
  message.changed_parameters = to_messages(changes.changed);
  return message;
}

}  // namespace rcl_cxx::detail
