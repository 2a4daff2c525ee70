#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ur_simulator {

/// The controller's software version. Major 3 is a CB3 controller (125 Hz), 5 an e-Series one (500 Hz).
struct PolyscopeVersion {
  std::uint32_t major = 5;
  std::uint32_t minor = 0;
  std::uint32_t bugfix = 0;
  std::uint32_t build = 0;

  auto operator<=>(const PolyscopeVersion &) const = default;

  bool is_e_series() const { return major >= 5; }
  /// Seconds a control cycle takes.
  double cycle_time() const { return is_e_series() ? 0.002 : 0.008; }
  /// "5.25.1.0"
  std::string text() const;
  /// "5.25", "5.25.1" or "5.25.1.130123"; nothing when it is not a version.
  static std::optional<PolyscopeVersion> parse(std::string_view text);
};

/// The version from which on something exists on each controller generation; `never` where it does not.
struct Since {
  static constexpr PolyscopeVersion always{0, 0, 0, 0};
  static constexpr PolyscopeVersion never{0xffffffff, 0, 0, 0};

  PolyscopeVersion e_series = always;
  PolyscopeVersion cb3 = always;

  bool holds_for(const PolyscopeVersion & version) const
  {
    return version >= (version.is_e_series() ? e_series : cb3);
  }
};

}  // namespace ur_simulator
