#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ur_simulator {

/// Version of the controller software. Major version 3 runs on CB3 controllers (125 Hz control rate), major
/// versions 5 and 10 (PolyScope X) on e-Series controllers (500 Hz).
struct PolyscopeVersion {
  std::uint32_t major = 5;
  std::uint32_t minor = 0;
  std::uint32_t bugfix = 0;
  std::uint32_t build = 0;

  auto operator<=>(const PolyscopeVersion &) const = default;

  bool is_e_series() const { return major >= 5; }
  bool is_polyscope_x() const { return major >= 10; }
  /// The version of PolyScope 5 whose controller has the same interfaces: 5.23 for 10.10, 5.25 for 10.12
  /// (Universal Robots Client Library: first versions of direct torque control and of friction scales).
  PolyscopeVersion controller_version() const
  {
    return is_polyscope_x() ? PolyscopeVersion{5, minor + 13, bugfix, build} : *this;
  }
  /// Duration of a control cycle, s.
  double cycle_time() const { return is_e_series() ? 0.002 : 0.008; }
  /// "5.25.1.0"
  std::string to_string() const;
  /// Parses "5.25", "5.25.1" or "5.25.1.130123". Returns nullopt if the text is not a version.
  static std::optional<PolyscopeVersion> parse(std::string_view text);
};

/// The first version of each controller generation that has a feature; `never` if the generation lacks it.
/// PolyScope X has the features of the version of PolyScope 5 with the same controller.
struct MinVersion {
  static constexpr PolyscopeVersion always{0, 0, 0, 0};
  static constexpr PolyscopeVersion never{0xffffffff, 0, 0, 0};

  PolyscopeVersion e_series = always;
  PolyscopeVersion cb3 = always;

  bool is_met_by(const PolyscopeVersion & version) const
  {
    return version.controller_version() >= (version.is_e_series() ? e_series : cb3);
  }
};

}  // namespace ur_simulator
