#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "log/event_log.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::primary {

/// Robot messages (type 20) of the primary and secondary interface, big-endian, as in UR's "Client Interface"
/// documents. What a client receives first.
std::string version_message(const PolyscopeVersion & version);
/// textmsg() of a program. `timestamp` in s.
std::string text_message(double timestamp, std::string_view text);
/// A program that could not be compiled or failed while it ran.
std::string runtime_exception_message(double timestamp, std::int32_t line, std::int32_t column,
                                      std::string_view text);

/// A program started ("PROGRAM_XXX_STARTED") or ended ("PROGRAM_XXX_STOPPED"): title and the program's name.
std::string key_message(double timestamp, std::string_view title, std::string_view text);
/// What the safety system reports.
std::string error_code_message(double timestamp, LogLevel level, std::string_view text);
/// A popup on the pendant's screen.
std::string popup_message(const LogEntry & entry);

/// The message that a log entry becomes on the primary interface, or "".
std::string message_for(const LogEntry & entry);

}  // namespace ur_simulator::primary
