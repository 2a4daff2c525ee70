#include "context/arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <rcl/allocator.h>
#include <rcl_yaml_param_parser/parser.h>

#include <memory>

#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
using GetIndices = decltype(&rcl_arguments_get_unparsed);

std::vector<std::string> get_arguments(GetIndices get_indices, int count, const rcl_arguments_t & arguments,
                                       const char * const * argv)
{
  std::vector<std::string> selected;
  if (count > 0) {
    const rcl_allocator_t allocator = rcl_get_default_allocator();
    int * indices = nullptr;
    check_rcl(get_indices(&arguments, allocator, &indices), "arguments", "cannot be read");
    for (int i = 0; i < count; ++i) {
      selected.emplace_back(argv[indices[i]]);
    }
    allocator.deallocate(indices, allocator.state);
  }
  return selected;
}

/// Removes and returns the first part of a name.
std::string_view take_part(std::string_view & name)
{
  name.remove_prefix(std::min(name.find_first_not_of('/'), name.size()));
  const std::string_view part = name.substr(0, name.find('/'));
  name.remove_prefix(part.size());
  return part;
}

template <typename T>
bool assign(ParameterValue & value, const T * source)
{
  if (source != nullptr) {
    value = *source;
  }
  return source != nullptr;
}

template <typename Array>
bool assign_array(ParameterValue & value, const Array * source)
{
  if (source != nullptr) {
    using Element = std::remove_cv_t<std::remove_pointer_t<decltype(source->values)>>;
    value = std::vector<Element>(source->values, source->values + source->size);
  }
  return source != nullptr;
}

ParameterValue to_value(const rcl_variant_t & variant)
{
  ParameterValue value;
  if (variant.string_value != nullptr) {
    value = std::string(variant.string_value);
  } else if (variant.string_array_value != nullptr) {
    const rcutils_string_array_t & strings = *variant.string_array_value;
    value = std::vector<std::string>(strings.data, strings.data + strings.size);
  } else {
    assign(value, variant.bool_value) || assign(value, variant.integer_value) ||
        assign(value, variant.double_value) || assign_array(value, variant.byte_array_value) ||
        assign_array(value, variant.bool_array_value) || assign_array(value, variant.integer_array_value) ||
        assign_array(value, variant.double_array_value);
  }
  return value;
}
}  // namespace

void check_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv)
{
  const auto unknown = get_arguments(&rcl_arguments_get_unparsed_ros,
                                     rcl_arguments_get_count_unparsed_ros(&arguments), arguments, argv);
  if (!unknown.empty()) {
    throw Error(fmt::format(
        "unknown ROS arguments: {}. Arguments for the program itself belong before --ros-args, or after a "
        "closing --",
        fmt::join(unknown, " ")));
  }
}

std::vector<std::string> remove_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv)
{
  return get_arguments(&rcl_arguments_get_unparsed, rcl_arguments_get_count_unparsed(&arguments), arguments,
                       argv);
}

bool matches_node(std::string_view pattern, std::string_view fully_qualified_name)
{
  std::string_view name = fully_qualified_name;
  const std::string_view first = take_part(pattern);
  if (first == "**") {
    if (matches_node(pattern, name)) {
      return true;
    }
    const std::string again = "**" + std::string(pattern);
    return !take_part(name).empty() && matches_node(again, name);
  }
  const std::string_view part = take_part(name);
  if (first.empty() || part.empty()) {
    return first.empty() && part.empty();
  }
  return (first == "*" || first == part) && matches_node(pattern, name);
}

std::map<std::string, ParameterValue> read_parameter_overrides(const rcl_arguments_t & arguments,
                                                               const std::string & fully_qualified_name)
{
  std::map<std::string, ParameterValue> overrides;
  rcl_params_t * read = nullptr;
  check_rcl(rcl_arguments_get_param_overrides(&arguments, &read), "parameters of the command line",
            "cannot be read");
  if (read == nullptr) {
    return overrides;
  }
  const std::unique_ptr<rcl_params_t, void (*)(rcl_params_t *)> params(read, &rcl_yaml_node_struct_fini);
  for (std::size_t n = 0; n < params->num_nodes; ++n) {
    if (matches_node(params->node_names[n], fully_qualified_name)) {
      const rcl_node_params_t & node = params->params[n];
      for (std::size_t p = 0; p < node.num_params; ++p) {
        overrides[node.parameter_names[p]] = to_value(node.parameter_values[p]);
      }
    }
  }
  return overrides;
}

}  // namespace rcl_cxx::detail
