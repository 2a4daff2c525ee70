#include "ur_ros_rtde/plugin.hpp"

// What a library built against headers of another version would export.
extern "C" const ur_ros_rtde::PluginDescriptor * ur_ros_rtde_plugin_WrongAbi()
{
  static constexpr ur_ros_rtde::PluginDescriptor descriptor{ur_ros_rtde::plugin_abi_version + 1, "wrong_abi",
                                                            nullptr, nullptr};
  return &descriptor;
}
