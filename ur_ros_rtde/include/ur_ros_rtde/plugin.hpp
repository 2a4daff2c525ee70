#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "ur_ros_rtde_robot/program/script_extension.hpp"

namespace ur_ros_rtde {

class CommandHost;
class DashboardHost;

/// Changes whenever a plugin built against the headers of another version could not work.
constexpr std::uint32_t plugin_abi_version = 3;

/// A command of command_server, at its lowest: anything that can start an action server. Command<A>
/// (command.hpp) is what to derive from otherwise.
class CommandPlugin {
 public:
  virtual ~CommandPlugin() = default;
  /// Called once; `host` outlives the plugin. `name` is the plugin's and the action's, "move_l". An exception
  /// is reported with the plugin's name, and the plugin left out.
  virtual void start_action_server(CommandHost & host, const std::string & name) = 0;
  /// Nothing of the plugin runs once this has returned. Goals have ended before.
  virtual void stop_action_server() = 0;
  /// What the control program gets in addition for this plugin, if anything; Extension<A> (extension.hpp)
  /// gives it. Asked once, before any action server is started; the name is the plugin's.
  virtual std::optional<ScriptExtension> script_extension() const { return std::nullopt; }
};

/// The same for dashboard_server; DashboardCommand<A> (dashboard_command.hpp) is what to derive from.
class DashboardPlugin {
 public:
  virtual ~DashboardPlugin() = default;
  virtual void start_action_server(DashboardHost & host, const std::string & name) = 0;
  virtual void stop_action_server() = 0;
};

/// What a library says of one of its plugins. The host looks at nothing but `abi_version` before it knows
/// that this is its own.
struct PluginDescriptor {
  std::uint32_t abi_version;
  const char * name;
  CommandPlugin * (*create_command)();      ///< null for a dashboard plugin
  DashboardPlugin * (*create_dashboard)();  ///< null for a command plugin
};

namespace detail {
template <typename Plugin>
constexpr PluginDescriptor describe(const char * name)
{
  constexpr bool command = std::is_base_of_v<CommandPlugin, Plugin>;
  static_assert(command || std::is_base_of_v<DashboardPlugin, Plugin>,
                "a plugin derives from Command, DashboardCommand, CommandPlugin or DashboardPlugin");
  if constexpr (command) {
    return {plugin_abi_version, name, []() -> CommandPlugin * { return new Plugin; }, nullptr};
  } else {
    return {plugin_abi_version, name, nullptr, []() -> DashboardPlugin * { return new Plugin; }};
  }
}
}  // namespace detail

}  // namespace ur_ros_rtde

/// Makes `Class` (unqualified: write this in its namespace, in a .cpp) the plugin `action_name`.
/// plugins.xml names it: <class name="action_name" type="namespace::Class" base_class_type="…"/>.
#define UR_ROS_RTDE_EXPORT(Class, action_name)                                              \
  extern "C" __attribute__((visibility("default")))                                         \
  const ::ur_ros_rtde::PluginDescriptor * ur_ros_rtde_plugin_##Class()                      \
  {                                                                                         \
    static constexpr auto descriptor = ::ur_ros_rtde::detail::describe<Class>(action_name); \
    return &descriptor;                                                                     \
  }
