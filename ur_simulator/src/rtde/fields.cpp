#include "rtde/fields.hpp"

#include <algorithm>

namespace ur_simulator::rtde {
namespace {

template <typename Field>
const Field * find_field(const std::vector<Field> & fields, std::string_view name,
                         const PolyscopeVersion & version)
{
  const auto found = std::ranges::lower_bound(fields, name, {}, &Field::name);
  const bool exists = found != fields.end() && found->name == name && found->min_version.is_met_by(version);
  return exists ? &*found : nullptr;
}

}  // namespace

const OutputField * find_output_field(std::string_view name, const PolyscopeVersion & version)
{
  return find_field(output_fields(), name, version);
}

const InputField * find_input_field(std::string_view name, const PolyscopeVersion & version)
{
  return find_field(input_fields(), name, version);
}

}  // namespace ur_simulator::rtde
