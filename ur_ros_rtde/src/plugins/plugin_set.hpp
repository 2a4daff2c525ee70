#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugins/plugin_library.hpp"

namespace ur_ros_rtde {

/// The plugins of one server: made, started, and in the end stopped before their libraries are unloaded.
template <typename Plugin, typename Host>
class PluginSet {
 public:
  PluginSet() = default;
  ~PluginSet() { stop(); }
  PluginSet(const PluginSet &) = delete;
  PluginSet & operator=(const PluginSet &) = delete;

  /// Makes what can be made; what cannot is reported with plugin, package and cause.
  void load(const std::vector<PluginEntry> & entries, const ReportProblem & report)
  {
    for (const PluginEntry & entry : entries) {
      guarded(entry, "it threw when it was made", report, [&]() -> Status {
        const auto descriptor = libraries_.describe(entry);
        if (!descriptor) {
          return tl::unexpected(descriptor.error());
        }
        plugins_.push_back({entry, create(**descriptor)});
        return {};
      });
    }
  }

  /// Starts their action servers, in the same way.
  void start(Host & host, const ReportProblem & report)
  {
    with_each("it threw when it was started", report, [&host](const PluginEntry & entry, Plugin & plugin) {
      plugin.start_action_server(host, entry.name);
    });
  }

  /// Asks all for something, by name; one that throws is reported with `thrown` and left out.
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

  /// No plugin's code runs once this has returned, if their goals have ended.
  void stop()
  {
    for (auto & loaded : plugins_) {
      loaded.plugin->stop_action_server();
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
      why = fmt::format("{}: something unknown", thrown);
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
