#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
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

  /// Starts what can be started; what cannot is reported with plugin, package and cause.
  void start(const std::vector<PluginEntry> & entries, Host & host, const ReportProblem & report)
  {
    for (const PluginEntry & entry : entries) {
      if (Status status = start_one(entry, host); !status) {
        report(fmt::format("plugin {} of package {} is left out: {}", entry.name, entry.package,
                           status.error().message));
      }
    }
  }

  /// No plugin's code runs once this has returned, if their goals have ended.
  void stop()
  {
    for (auto & started : started_) {
      started.plugin->stop_action_server();
    }
    started_.clear();
  }

  std::vector<std::string> names() const
  {
    std::vector<std::string> names;
    for (const auto & started : started_) {
      names.push_back(started.name);
    }
    return names;
  }

 private:
  struct Started {
    std::string name;
    std::unique_ptr<Plugin> plugin;
  };

  Status start_one(const PluginEntry & entry, Host & host)
  {
    const auto descriptor = libraries_.describe(entry);
    if (!descriptor) {
      return tl::unexpected(descriptor.error());
    }
    try {
      std::unique_ptr<Plugin> plugin = create(**descriptor);
      plugin->start_action_server(host, entry.name);
      started_.push_back({entry.name, std::move(plugin)});
      return {};
    } catch (const std::exception & error) {
      return failure(ErrorCode::exception, fmt::format("it threw when it was made: {}", error.what()));
    } catch (...) {
      return failure(ErrorCode::exception, "it threw something unknown when it was made");
    }
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
  std::vector<Started> started_;
};

}  // namespace ur_ros_rtde
