#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include "ur_ros_rtde_robot/script/script_extension.hpp"

namespace ur_ros_rtde {

class CommandHost;
class DashboardHost;

/// The interface of a plugin of command_server. Derive from Command<A> (command.hpp) unless the plugin needs
/// an action server of its own kind.
class CommandPlugin {
 public:
  virtual ~CommandPlugin() = default;
  /// Called first, before the connection to the robot: for what the plugin needs besides its goals, such as
  /// parameters, topics, services and timers of host.node(), or a Supervision. Callbacks run in the thread
  /// of host.callbacks() if that is their group, otherwise in the one that accepts the goals of all commands,
  /// and must not wait there. Stops have a thread of their own. If it throws, the plugin is not used.
  virtual void on_load(CommandHost &) {}
  /// Called last, after stop_action_server(); not for a plugin that could not be started, which is destroyed.
  virtual void on_unload() {}
  /// Called once. `host` outlives the plugin. `name` is the name of the plugin and of its action: "move_l".
  /// If it throws, the error is reported with the plugin's name, and the plugin is not used.
  virtual void start_action_server(CommandHost & host, const std::string & name) = 0;
  /// No code of the plugin runs after this function has returned. Its goals have ended before.
  virtual void stop_action_server() = 0;
  /// The URScript that this plugin adds to the control program, if any; see Extension<A> (extension.hpp).
  /// Called before any action server is started, and returns the same each time.
  virtual std::optional<ScriptExtension> script_extension() const { return std::nullopt; }
};

/// The interface of a plugin of dashboard_server. Derive from DashboardCommand<A> (dashboard_command.hpp).
class DashboardPlugin {
 public:
  virtual ~DashboardPlugin() = default;
  /// As those of CommandPlugin.
  virtual void on_load(DashboardHost &) {}
  virtual void on_unload() {}
  virtual void start_action_server(DashboardHost & host, const std::string & name) = 0;
  virtual void stop_action_server() = 0;
};

// For the driver

/// How a library describes one of its plugins. The host reads it after it has found that the library was
/// built with the host's own headers (cmake/plugin_abi.cmake).
struct PluginDescriptor {
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
    return {name, []() -> CommandPlugin * { return new Plugin; }, nullptr};
  } else {
    return {name, nullptr, []() -> DashboardPlugin * { return new Plugin; }};
  }
}
}  // namespace detail

}  // namespace ur_ros_rtde

/// Exports `Class` as the plugin `action_name`. Use it in a .cpp file, in the namespace of `Class`. The
/// plugin description names it: `<class name="action_name" type="namespace::Class" base_class_type="…"/>`.
#define UR_ROS_RTDE_EXPORT(Class, action_name)                                              \
  extern "C" __attribute__((visibility("default")))                                         \
  const ::ur_ros_rtde::PluginDescriptor * ur_ros_rtde_plugin_##Class()                      \
  {                                                                                         \
    static constexpr auto descriptor = ::ur_ros_rtde::detail::describe<Class>(action_name); \
    return &descriptor;                                                                     \
  }
