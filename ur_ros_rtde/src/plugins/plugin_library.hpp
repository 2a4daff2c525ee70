#pragma once

#include <map>
#include <memory>
#include <rcpputils/shared_library.hpp>
#include <string>

#include "plugins/plugin_index.hpp"
#include "ur_ros_rtde/plugin.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Plugin libraries, each loaded once and unloaded by the destructor. Destroy it after all plugins and
/// everything that may run their code.
class PluginLibraries {
 public:
  /// Loads the library of a plugin and returns the descriptor if it is compatible with this driver. The error
  /// describes what is wrong with the library.
  Expected<const PluginDescriptor *> describe(const PluginEntry & entry);

 private:
  Expected<rcpputils::SharedLibrary *> load(const std::string & path);

  std::map<std::string, std::unique_ptr<rcpputils::SharedLibrary>> libraries_;
};

}  // namespace ur_ros_rtde
