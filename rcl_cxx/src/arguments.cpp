#include "arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <rcl/allocator.h>
#include <rcl_yaml_param_parser/parser.h>

#include <memory>

#include "rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
std::vector<const char *> pointers_to(const std::vector<std::string> & arguments)
{
  std::vector<const char *> pointers;
  for (const std::string & argument : arguments) {
    pointers.push_back(argument.c_str());
  }
  return pointers;
}

std::vector<std::string_view> parts_of(std::string_view name)
{
  std::vector<std::string_view> parts;
  while (!name.empty()) {
    const std::size_t slash = name.find('/');
    const std::string_view part = name.substr(0, slash);
    if (!part.empty()) {
      parts.push_back(part);
    }
    name = slash == std::string_view::npos ? std::string_view{} : name.substr(slash + 1);
  }
  return parts;
}

using Part = std::vector<std::string_view>::const_iterator;

bool parts_match(Part pattern, Part pattern_end, Part name, Part name_end)
{
  if (pattern == pattern_end) {
    return name == name_end;
  }
  if (*pattern == "**") {
    return parts_match(pattern + 1, pattern_end, name, name_end) ||
           (name != name_end && parts_match(pattern, pattern_end, name + 1, name_end));
  }
  return name != name_end && (*pattern == "*" || *pattern == *name) &&
         parts_match(pattern + 1, pattern_end, name + 1, name_end);
}

template <typename Array>
auto to_vector(const Array & array)
{
  using Element = std::remove_cv_t<std::remove_pointer_t<decltype(array.values)>>;
  return std::vector<Element>(array.values, array.values + array.size);
}

ParameterValue to_value(const rcl_variant_t & variant)
{
  if (variant.bool_value != nullptr) {
    return *variant.bool_value;
  }
  if (variant.integer_value != nullptr) {
    return *variant.integer_value;
  }
  if (variant.double_value != nullptr) {
    return *variant.double_value;
  }
  if (variant.string_value != nullptr) {
    return std::string(variant.string_value);
  }
  if (variant.byte_array_value != nullptr) {
    return to_vector(*variant.byte_array_value);
  }
  if (variant.bool_array_value != nullptr) {
    return to_vector(*variant.bool_array_value);
  }
  if (variant.integer_array_value != nullptr) {
    return to_vector(*variant.integer_array_value);
  }
  if (variant.double_array_value != nullptr) {
    return to_vector(*variant.double_array_value);
  }
  if (variant.string_array_value != nullptr) {
    const rcutils_string_array_t & strings = *variant.string_array_value;
    return std::vector<std::string>(strings.data, strings.data + strings.size);
  }
  return {};
}
}  // namespace

ParsedArguments::ParsedArguments(const std::vector<std::string> & arguments)
    : arguments_(rcl_get_zero_initialized_arguments())
{
  const std::vector<const char *> argv = pointers_to(arguments);
  check_rcl(rcl_parse_arguments(static_cast<int>(argv.size()), argv.data(), rcl_get_default_allocator(),
                                &arguments_),
            "node arguments", fmt::format("cannot be understood: {}", fmt::join(arguments, " ")));
  try {
    refuse_unknown_ros_arguments(arguments_, argv.data());
  } catch (...) {
    ignore_rcl(rcl_arguments_fini(&arguments_));
    throw;
  }
}

ParsedArguments::~ParsedArguments()
{
  if (arguments_.impl != nullptr) {
    ignore_rcl(rcl_arguments_fini(&arguments_));
  }
}

void refuse_unknown_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv)
{
  const int count = rcl_arguments_get_count_unparsed_ros(&arguments);
  if (count <= 0) {
    return;
  }
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  int * indices = nullptr;
  check_rcl(rcl_arguments_get_unparsed_ros(&arguments, allocator, &indices), "arguments", "cannot be read");
  std::vector<std::string> unknown;
  for (int i = 0; i < count; ++i) {
    unknown.emplace_back(argv[indices[i]]);
  }
  allocator.deallocate(indices, allocator.state);
  throw Error(
      fmt::format("unknown ROS arguments: {}. Arguments for the program itself stand before --ros-args, or "
                  "after a closing --",
                  fmt::join(unknown, " ")));
}

std::vector<std::string> without_ros_arguments(const rcl_arguments_t & arguments, const char * const * argv)
{
  const int count = rcl_arguments_get_count_unparsed(&arguments);
  if (count <= 0) {
    return {};
  }
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  int * indices = nullptr;
  check_rcl(rcl_arguments_get_unparsed(&arguments, allocator, &indices), "arguments", "cannot be read");
  std::vector<std::string> rest;
  for (int i = 0; i < count; ++i) {
    rest.emplace_back(argv[indices[i]]);
  }
  allocator.deallocate(indices, allocator.state);
  return rest;
}

bool names_node(std::string_view pattern, std::string_view fully_qualified_name)
{
  const auto pattern_parts = parts_of(pattern);
  const auto name_parts = parts_of(fully_qualified_name);
  return parts_match(pattern_parts.begin(), pattern_parts.end(), name_parts.begin(), name_parts.end());
}

void read_parameter_overrides(const rcl_arguments_t & arguments, const std::string & fully_qualified_name,
                              std::map<std::string, ParameterValue> & overrides)
{
  rcl_params_t * read = nullptr;
  check_rcl(rcl_arguments_get_param_overrides(&arguments, &read), "parameters of the command line",
            "cannot be read");
  if (read == nullptr) {
    return;
  }
  const std::unique_ptr<rcl_params_t, void (*)(rcl_params_t *)> params(read, &rcl_yaml_node_struct_fini);
  for (std::size_t n = 0; n < params->num_nodes; ++n) {
    if (!names_node(params->node_names[n], fully_qualified_name)) {
      continue;
    }
    const rcl_node_params_t & node = params->params[n];
    for (std::size_t p = 0; p < node.num_params; ++p) {
      overrides[node.parameter_names[p]] = to_value(node.parameter_values[p]);
    }
  }
}

}  // namespace rcl_cxx::detail
