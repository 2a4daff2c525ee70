#include "process/fastdds_profile.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>

#include "plugins/ament_index.hpp"

namespace ur_ros_rtde {
namespace {
namespace fs = std::filesystem;

/// Where a version of Fast DDS looks for profiles: the file that an environment variable names, and the
/// working directory. Only the package_file for the installed version is installed.
struct ProfileSource {
  const char * variable;
  const char * local_file;
  const char * package_file;
};
constexpr std::array sources{
    ProfileSource{"FASTDDS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTDDS_PROFILES.xml", "fastdds.xml"},
    ProfileSource{"FASTRTPS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTRTPS_PROFILES.xml", "fastrtps.xml"},
};

bool is_present(const fs::path & file)
{
  std::error_code ignored;
  return fs::exists(file, ignored);
}

std::optional<fs::path> chosen_profile()
{
  for (const ProfileSource & source : sources) {
    if (const char * const file = std::getenv(source.variable)) {
      return file;
    }
    if (is_present(source.local_file)) {
      return source.local_file;
    }
  }
  return std::nullopt;
}

bool mentions(const fs::path & file, const std::string & text)
{
  std::ifstream stream(file);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  return content.find(text) != std::string::npos;
}

std::optional<fs::path> config_folder()
{
  try {
    return ament_index::share_folder("ur_ros_rtde") / "config";
  } catch (const std::exception &) {
    return std::nullopt;  // without an ament index there are no plugins either, which the nodes report
  }
}
}  // namespace

void use_fastdds_profile()
{
  const auto folder = config_folder();
  if (!folder || chosen_profile()) {
    return;
  }
  for (const ProfileSource & source : sources) {
    if (const fs::path file = *folder / source.package_file; is_present(file)) {
      ::setenv(source.variable, file.c_str(), 1);
    }
  }
}

void report_fastdds_profile(const rcl_cxx::Logger & logger)
{
  constexpr const char * property = "fastdds.type_propagation";
  const auto folder = config_folder();
  const auto profile = chosen_profile();
  const bool needed = folder && is_present(*folder / "fastdds.xml");  // not with Fast DDS 2
  if (needed && profile && is_present(*profile) && !mentions(*profile, property)) {
    RCL_CXX_INFO(logger,
                 "the Fast DDS profile {} leaves {} enabled: after a client was killed, new clients may not "
                 "discover the actions for a minute, see docs/discovery.md",
                 profile->string(), property);
  }
}

}  // namespace ur_ros_rtde
