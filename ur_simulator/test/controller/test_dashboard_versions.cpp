#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "dashboard/commands.hpp"

namespace ur_simulator::testing {
namespace {

/// A command and the first version of each controller generation that has it (UR, "Dashboard Server
/// e-Series", "Dashboard Server CB-Series" and version table of the Universal Robots Client Library).
/// nullopt: never.
struct DocumentedCommand {
  std::string name;
  std::optional<std::string> e_series;
  std::optional<std::string> cb3;
};

const std::vector<DocumentedCommand> documented_commands{
    {"load", "5.0", "3.0"},
    {"play", "5.0", "3.0"},
    {"stop", "5.0", "3.0"},
    {"pause", "5.0", "3.0"},
    {"quit", "5.0", "3.0"},
    {"shutdown", "5.0", "3.0"},
    {"running", "5.0", "3.0"},
    {"robotmode", "5.0", "3.0"},
    {"get loaded program", "5.0", "3.0"},
    {"popup", "5.0", "3.0"},
    {"close popup", "5.0", "3.0"},
    {"addToLog", "5.0", "3.0"},
    {"isProgramSaved", "5.0", "3.0"},
    {"programState", "5.0", "3.0"},
    {"PolyscopeVersion", "5.0", "3.0"},
    {"version", "5.0", std::nullopt},
    {"setUserRole", std::nullopt, "3.1"},
    {"getUserRole", std::nullopt, "3.1"},
    {"set operational mode", "5.0", std::nullopt},
    {"get operational mode", "5.6", std::nullopt},
    {"clear operational mode", "5.0", std::nullopt},
    {"power on", "5.0", "3.0"},
    {"power off", "5.0", "3.0"},
    {"brake release", "5.0", "3.0"},
    {"safetymode", "5.0", "3.0"},
    {"safetystatus", "5.4", "3.11"},
    {"unlock protective stop", "5.0", "3.1"},
    {"close safety popup", "5.0", "3.1"},
    {"load installation", "5.0", "3.2"},
    {"restart safety", "5.1", "3.7"},
    {"is in remote control", "5.6", std::nullopt},
    {"get serial number", "5.6", "3.12"},
    {"get robot model", "5.6", "3.12"},
    {"generate flight report", "5.8", "3.13"},
    {"generate support file", "5.8", "3.13"},
    {"saveLog", "5.8", "3.13"},
};

bool understands(const std::string & version, const std::string & name)
{
  std::string_view argument;
  const dashboard::Command * const command =
      dashboard::find_command(name, *PolyscopeVersion::parse(version), argument);
  // "load installation" is "load" with an argument in versions that lack it.
  return command != nullptr && command->name == name;
}

void expect_first_version(const std::string & name, const std::optional<std::string> & first,
                          const std::vector<std::string> & versions)
{
  for (const std::string & version : versions) {
    const bool expected = first && *PolyscopeVersion::parse(version) >= *PolyscopeVersion::parse(*first);
    EXPECT_EQ(understands(version, name), expected) << name << " in " << version;
  }
}

TEST(DashboardVersionTest, UnderstandsEachCommandFromItsFirstVersion)
{
  for (const DocumentedCommand & command : documented_commands) {
    expect_first_version(command.name, command.e_series,
                         {"5.0", "5.1", "5.3", "5.4", "5.5", "5.6", "5.7", "5.8", "5.25"});
    expect_first_version(command.name, command.cb3,
                         {"3.0", "3.1", "3.2", "3.6", "3.7", "3.10", "3.11", "3.12", "3.13", "3.15"});
  }
}

}  // namespace
}  // namespace ur_simulator::testing
