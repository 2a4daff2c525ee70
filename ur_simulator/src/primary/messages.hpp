#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "log/event_log.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::primary {

// Encoding of the robot messages (message type 20) of the primary and secondary interface (UR, "Client
// Interface"). Values are big-endian. Timestamps are in s.

/// Sent to each client when it connects.
std::string version_message(const PolyscopeVersion & version);
/// textmsg() of a program.
std::string text_message(double timestamp, std::string_view text);
/// Compile and run-time errors of programs.
std::string runtime_exception_message(double timestamp, std::int32_t line, std::int32_t column,
                                      std::string_view text);

/// Start or end of a program: title "PROGRAM_XXX_STARTED" or "PROGRAM_XXX_STOPPED", text: name of the
/// program.
std::string key_message(double timestamp, std::string_view title, std::string_view text);
std::string error_code_message(double timestamp, const ErrorCode & code, std::string_view text);
/// `safety_mode` as in the RTDE output safety_mode.
std::string safety_mode_message(double timestamp, std::uint8_t safety_mode);
/// A value that the program asks the operator to enter.
std::string request_value_message(const LogEntry & entry);
/// A popup on the pendant's screen.
std::string popup_message(const LogEntry & entry);

/// The robot message that reports a log entry, or "" if the primary interface does not report it.
std::string robot_message_for(const LogEntry & entry);
/// The name of this message in the client log, such as "error code message C153A2".
std::string robot_message_name(const LogEntry & entry);

}  // namespace ur_simulator::primary
