#pragma once

#include <map>
#include <memory>
#include <rcpputils/shared_library.hpp>
#include <string>

#include "plugins/plugin_index.hpp"
#include "ur_ros_rtde/plugin.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Plugin libraries, each loaded once, and unloaded with this object: after the plugins made from them and
/// everything that may run their code.
class PluginLibraries {
 public:
  /// The plugin's descriptor, after checking that it is one for this driver. The error says what is wrong
  /// with the library.
  Expected<const PluginDescriptor *> describe(const PluginEntry & entry);

 private:
  Expected<rcpputils::SharedLibrary *> load(const std::string & path);

  std::map<std::string, std::unique_ptr<rcpputils::SharedLibrary>> libraries_;
};

}  // namespace ur_ros_rtde
