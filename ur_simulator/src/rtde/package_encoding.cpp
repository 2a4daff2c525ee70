#include "rtde/package_encoding.hpp"

#include <array>

namespace ur_simulator::rtde {
namespace {

struct TypeDescription {
  std::string_view name;
  std::size_t size;
};

constexpr std::array<TypeDescription, 9> type_descriptions{{{"BOOL", 1},
                                                            {"UINT8", 1},
                                                            {"UINT32", 4},
                                                            {"UINT64", 8},
                                                            {"INT32", 4},
                                                            {"DOUBLE", 8},
                                                            {"VECTOR3D", 24},
                                                            {"VECTOR6D", 48},
                                                            {"VECTOR6INT32", 24}}};

}  // namespace

std::string_view type_name(FieldType type)
{
  return type_descriptions[static_cast<std::size_t>(type)].name;
}

std::size_t encoded_size(FieldType type)
{
  return type_descriptions[static_cast<std::size_t>(type)].size;
}

std::vector<std::string_view> split_names(std::string_view names)
{
  std::vector<std::string_view> parts;
  while (!names.empty()) {
    const std::size_t comma = names.find(',');
    parts.push_back(names.substr(0, comma));
    names.remove_prefix(comma == std::string_view::npos ? names.size() : comma + 1);
  }
  return parts;
}

}  // namespace ur_simulator::rtde
