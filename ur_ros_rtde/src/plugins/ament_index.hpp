#pragma once

/// The functions of ament_index_cpp whose names differ between distributions. Those of Kilted and earlier are
/// deprecated in Lyrical and absent in Rolling.

#include <ament_index_cpp/get_resources.hpp>
#include <filesystem>
#include <map>
#include <string>

#if __has_include(<ament_index_cpp/version.h>)
#include <ament_index_cpp/version.h>
#endif

#if __has_include(<ament_index_cpp/get_package_share_path.hpp>)
#include <ament_index_cpp/get_package_share_path.hpp>
#else
#include <ament_index_cpp/get_package_share_directory.hpp>
#endif

namespace ur_ros_rtde::ament_index {

/// The packages that register a resource of `type`, with their installation prefix.
inline std::map<std::string, std::filesystem::path> resources(const std::string & type)
{
#if AMENT_INDEX_CPP_VERSION_MAJOR > 1 || AMENT_INDEX_CPP_VERSION_MINOR >= 13
  return ament_index_cpp::get_resources_by_name(type);
#else
  const auto found = ament_index_cpp::get_resources(type);
  return {found.begin(), found.end()};
#endif
}

/// @throws std::out_of_range if the package is not installed
inline std::filesystem::path share_folder(const std::string & package)
{
#if __has_include(<ament_index_cpp/get_package_share_path.hpp>)
  return ament_index_cpp::get_package_share_path(package);
#else
  return ament_index_cpp::get_package_share_directory(package);
#endif
}

}  // namespace ur_ros_rtde::ament_index
