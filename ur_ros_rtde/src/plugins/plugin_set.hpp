#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugins/plugin_library.hpp"

namespace ur_ros_rtde {

/// Creates, starts and stops the plugins of one server, and unloads their libraries at the end.
template <typename Plugin, typename Host>
class PluginSet {
 public:
  PluginSet() = default;
  ~PluginSet() { stop(); }
  PluginSet(const PluginSet &) = delete;
  PluginSet & operator=(const PluginSet &) = delete;

  /// Creates plugins. A plugin that fails is reported with its name, its package and the cause, and left out.
  void load(const std::vector<PluginEntry> & entries, const ReportProblem & report)
  {
    for (const PluginEntry & entry : entries) {
      guarded(entry, "its constructor threw", report, [&]() -> Status {
        const auto descriptor = libraries_.describe(entry);
        if (!descriptor) {
          return tl::unexpected(descriptor.error());
        }
        plugins_.push_back({entry, create(**descriptor)});
        return {};
      });
    }
  }

  /// Calls on_load() of each plugin, with the same handling of errors.
  void initialize(Host & host, const ReportProblem & report)
  {
    with_each("on_load() threw", report, [&](const PluginEntry &, Plugin & plugin) { plugin.on_load(host); });
  }

  /// Starts the action servers, with the same handling of errors. Ends silently at a shutdown.
  void start(Host & host, const ReportProblem & report)
  {
    const auto running = [&host] { return host.node().get_context()->ok(); };
    const auto report_if_running = [&](const std::string & problem) {
      if (running()) {
        report(problem);
      }
    };
    with_each("start_action_server() threw", report_if_running,
              [&](const PluginEntry & entry, Plugin & plugin) {
                if (running()) {
                  plugin.start_action_server(host, entry.name);
                }
              });
  }

  /// Calls `step` for each plugin, in the order of their names. A plugin whose call throws is reported with
  /// `thrown` and removed.
  void with_each(const char * thrown, const ReportProblem & report,
                 const std::function<void(const PluginEntry &, Plugin &)> & step)
  {
    std::erase_if(plugins_, [&](Loaded & loaded) {
      return !guarded(loaded.entry, thrown, report, [&]() -> Status {
        step(loaded.entry, *loaded.plugin);
        return {};
      });
    });
  }

  /// Stops the action servers and destroys the plugins. No code of a plugin runs afterwards, provided that
  /// its goals have ended. A plugin that throws is destroyed nevertheless.
  void stop()
  {
    for (auto & loaded : plugins_) {
      try {
        loaded.plugin->stop_action_server();
        loaded.plugin->on_unload();
      } catch (...) {  // the destructor of the plugin ends both in any case
      }
    }
    plugins_.clear();
  }

  std::vector<std::string> names() const
  {
    std::vector<std::string> names;
    for (const auto & loaded : plugins_) {
      names.push_back(loaded.entry.name);
    }
    return names;
  }

 private:
  struct Loaded {
    PluginEntry entry;
    std::unique_ptr<Plugin> plugin;
  };

  static bool guarded(const PluginEntry & entry, const char * thrown, const ReportProblem & report,
                      const std::function<Status()> & step)
  {
    std::optional<std::string> why;
    try {
      if (const Status status = step(); !status) {
        why = status.error().message;
      }
    } catch (const std::exception & error) {
      why = fmt::format("{}: {}", thrown, error.what());
    } catch (...) {
      why = fmt::format("{} an exception of an unknown type", thrown);
    }
    if (why) {
      report(fmt::format("plugin {} of package {} is left out: {}", entry.name, entry.package, *why));
    }
    return !why;
  }

  static std::unique_ptr<Plugin> create(const PluginDescriptor & descriptor)
  {
    if constexpr (std::is_same_v<Plugin, CommandPlugin>) {
      return std::unique_ptr<Plugin>(descriptor.create_command());
    } else {
      return std::unique_ptr<Plugin>(descriptor.create_dashboard());
    }
  }

  PluginLibraries libraries_;
  std::vector<Loaded> plugins_;
};

}  // namespace ur_ros_rtde
