#include "plugins/plugin_library.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace ur_ros_rtde {
namespace {
std::string symbol_of(const std::string & type)
{
  const auto colon = type.rfind(':');
  return "ur_ros_rtde_plugin_" + (colon == std::string::npos ? type : type.substr(colon + 1));
}

/// Success if a library was built with the headers of this driver.
Status check_abi(rcpputils::SharedLibrary & library, const std::string & path)
{
  constexpr const char * symbol_name = "ur_ros_rtde_plugin_abi";
  if (!library.has_symbol(symbol_name)) {
    return failure(
        ErrorCode::exception,
        fmt::format("{} has no symbol {}: call ur_ros_rtde_register_plugins() in its CMakeLists.txt, "
                    "and build it again with this driver",
                    path, symbol_name));
  }
  using Abi = const char * (*)();
  const std::string abi = reinterpret_cast<Abi>(library.get_symbol(symbol_name))();
  if (abi != UR_ROS_RTDE_PLUGIN_ABI) {
    return failure(
        ErrorCode::exception,
        fmt::format("{} was built with the headers of another version of this driver ({}, not {}): "
                    "build it again with this driver",
                    path, abi, UR_ROS_RTDE_PLUGIN_ABI));
  }
  return {};
}
}  // namespace

Expected<rcpputils::SharedLibrary *> PluginLibraries::load(const std::string & path)
{
  const auto known = libraries_.find(path);
  if (known != libraries_.end()) {
    return known->second.get();
  }
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return failure(ErrorCode::exception, fmt::format("its library {} does not exist", path));
  }
  try {
    auto library = std::make_unique<rcpputils::SharedLibrary>(path);
    if (Status same = check_abi(*library, path); !same) {
      return tl::unexpected(same.error());
    }
    return libraries_.emplace(path, std::move(library)).first->second.get();
  } catch (const std::exception & error) {
    return failure(ErrorCode::exception, fmt::format("its library cannot be loaded: {}", error.what()));
  }
}

Expected<const PluginDescriptor *> PluginLibraries::describe(const PluginEntry & entry)
{
  const auto library = load(entry.library);
  if (!library) {
    return tl::unexpected(library.error());
  }
  const std::string symbol = symbol_of(entry.type);
  using Entry = const PluginDescriptor * (*)();
  const PluginDescriptor * const descriptor =
      (*library)->has_symbol(symbol) ? reinterpret_cast<Entry>((*library)->get_symbol(symbol))() : nullptr;
  if (descriptor == nullptr) {
    return failure(
        ErrorCode::exception,
        fmt::format("{} has no symbol {}: UR_ROS_RTDE_EXPORT({}, \"{}\") is missing there", entry.library,
                    symbol, symbol.substr(sizeof("ur_ros_rtde_plugin_") - 1), entry.name));
  }
  if (descriptor->name != entry.name) {
    return failure(ErrorCode::exception,
                   fmt::format("{} exports it as \"{}\", but plugins.xml names it \"{}\": use the same name",
                               entry.library, descriptor->name, entry.name));
  }
  const bool command = entry.base == command_base;
  if ((command ? static_cast<bool>(descriptor->create_command)
               : static_cast<bool>(descriptor->create_dashboard)) == false) {
    return failure(ErrorCode::exception,
                   fmt::format("{} does not derive from {}, as plugins.xml says", entry.type, entry.base));
  }
  return descriptor;
}

}  // namespace ur_ros_rtde
