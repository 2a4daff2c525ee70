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
/// working directory. Only the files of this package for the installed version are installed.
struct ProfileSource {
  const char * variable;
  const char * local_file;
  const char * client_file;
  const char * node_file;
};
constexpr std::array sources{
    ProfileSource{"FASTDDS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTDDS_PROFILES.xml", "fastdds.xml",
                  "fastdds_nodes.xml"},
    ProfileSource{"FASTRTPS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTRTPS_PROFILES.xml", "fastrtps.xml",
                  "fastrtps.xml"},
};

bool is_present(const fs::path & file)
{
  std::error_code ignored;
  return fs::exists(file, ignored);
}

bool is_same_file(const fs::path & one, const fs::path & other)
{
  std::error_code ignored;
  return fs::equivalent(one, other, ignored);
}

/// Returns the profile of the user. The profile of this package for clients, which may be in the environment,
/// is not one of the user.
std::optional<fs::path> chosen_profile(const fs::path & folder)
{
  for (const ProfileSource & source : sources) {
    const char * const file = std::getenv(source.variable);
    if (file != nullptr && !is_same_file(file, folder / source.client_file)) {
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
  if (!folder || chosen_profile(*folder)) {
    return;
  }
  for (const ProfileSource & source : sources) {
    if (const fs::path file = *folder / source.node_file; is_present(file)) {
      ::setenv(source.variable, file.c_str(), 1);
    }
  }
}

void report_fastdds_profile(const rcl_cxx::Logger & logger)
{
  constexpr const char * property = "fastdds.type_propagation";
  const auto folder = config_folder();
  const auto profile = folder ? chosen_profile(*folder) : std::nullopt;
  const bool needed = folder && is_present(*folder / "fastdds_nodes.xml");  // not with Fast DDS 2
  if (needed && profile && is_present(*profile) && !mentions(*profile, property)) {
    RCL_CXX_INFO(logger,
                 "the Fast DDS profile {} leaves {} enabled: after a client was killed, new clients may not "
                 "discover the actions for a minute, see docs/use/networks.md",
                 profile->string(), property);
  }
}

}  // namespace ur_ros_rtde
