#pragma once

#include <cstdint>

namespace ur_simulator {

/// Severity of an error code (UR, "Client Interface", robotMessageReportLevel).
enum class ReportLevel : std::uint32_t { debug = 0, info = 1, warning = 2, violation = 3, fault = 4 };

/// An error code of the controller, such as C153A2 (UR, "Error Codes"): code 153, argument 2.
struct ErrorCode {
  std::int32_t code = 0;  ///< 0: the number of the robot is not known
  std::int32_t argument = 0;
  ReportLevel level = ReportLevel::warning;
};

/// Error codes of the simulated conditions (UR, "Error Codes", SW5_25). Protective stops are warnings
/// (Universal Robots Client Library, test_primary_client.cpp).
namespace error_codes {

constexpr ErrorCode close_to_joint_limits{150};
constexpr ErrorCode singularity{154};
constexpr ErrorCode collision_detected{157};
constexpr ErrorCode danger_of_clamping{403};
constexpr ErrorCode sudden_change_of_target{204, 1};
constexpr ErrorCode invalid_setpoint{204, 5};
constexpr ErrorCode read_only_interface{210, 0, ReportLevel::violation};
constexpr ErrorCode requested_protective_stop{209};
constexpr ErrorCode unnumbered_protective_stop{};
constexpr ErrorCode safety_violation{0, 0, ReportLevel::violation};
constexpr ErrorCode safety_fault{0, 0, ReportLevel::fault};

/// The joint (0..5) deviates from its path. Without payload, the code asks to check the payload.
constexpr ErrorCode position_deviates(std::int32_t joint, bool has_payload)
{
  return {has_payload ? 153 : 159, joint};
}

/// The joint (0..5) detects a collision.
constexpr ErrorCode collision_detected_by(std::int32_t joint, bool has_payload)
{
  return {has_payload ? collision_detected.code : 158, joint};
}

}  // namespace error_codes
}  // namespace ur_simulator
