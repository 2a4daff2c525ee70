#include "primary/messages.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/big_endian.hpp"

namespace ur_simulator::primary {
namespace {

constexpr std::uint8_t robot_message = 20;
constexpr std::uint32_t no_data = 0;  // type of the data of error code and safety mode messages

enum class MessageType : std::uint8_t {
  text = 0,
  popup = 2,
  version = 3,
  safety_mode = 5,
  error_code = 6,
  key = 7,
  request_value = 9,
  runtime_exception = 10
};

/// As in the messages that the tests of the Universal Robots Client Library contain.
std::uint8_t source_of(MessageType type)
{
  constexpr std::uint8_t robot_interface = 0xfe;  // -2
  constexpr std::uint8_t runtime_machine = 0xfd;  // -3
  return type == MessageType::version || type == MessageType::key ? robot_interface : runtime_machine;
}

std::string begin_message(MessageType type, double timestamp)
{
  std::string message;
  put_u32(message, 0);  // size, set by finish_message()
  put_u8(message, robot_message);
  put_u64(message, static_cast<std::uint64_t>(timestamp * 1e6));
  put_u8(message, source_of(type));
  put_u8(message, static_cast<std::uint8_t>(type));
  return message;
}

std::string finish_message(std::string message)
{
  std::string size;
  put_u32(size, static_cast<std::uint32_t>(message.size()));
  return message.replace(0, size.size(), size);
}

}  // namespace

std::string version_message(const PolyscopeVersion & version)
{
  constexpr std::string_view project = "URControl";
  std::string message = begin_message(MessageType::version, 0.0);
  put_u8(message, static_cast<std::uint8_t>(project.size()));
  message += project;
  put_u8(message, static_cast<std::uint8_t>(version.major));
  put_u8(message, static_cast<std::uint8_t>(version.minor));
  put_u32(message, version.bugfix);
  put_u32(message, version.build);
  message += "01-01-2025, 00:00:00";
  return finish_message(std::move(message));
}

std::string text_message(double timestamp, std::string_view text)
{
  std::string message = begin_message(MessageType::text, timestamp);
  message += text;
  return finish_message(std::move(message));
}

std::string runtime_exception_message(double timestamp, std::int32_t line, std::int32_t column,
                                      std::string_view text)
{
  std::string message = begin_message(MessageType::runtime_exception, timestamp);
  put_u32(message, static_cast<std::uint32_t>(line));
  put_u32(message, static_cast<std::uint32_t>(column));
  message += text;
  return finish_message(std::move(message));
}

std::string key_message(double timestamp, std::string_view title, std::string_view text)
{
  std::string message = begin_message(MessageType::key, timestamp);
  put_u32(message, 0);  // code
  put_u32(message, 0);  // argument
  put_u8(message, static_cast<std::uint8_t>(title.size()));
  message += title;
  message += text;
  return finish_message(std::move(message));
}

std::string error_code_message(double timestamp, const ErrorCode & code, std::string_view text)
{
  std::string message = begin_message(MessageType::error_code, timestamp);
  put_u32(message, static_cast<std::uint32_t>(code.code));
  put_u32(message, static_cast<std::uint32_t>(code.argument));
  put_u32(message, static_cast<std::uint32_t>(code.level));
  put_u32(message, no_data);
  put_u32(message, 0);
  message += text;
  return finish_message(std::move(message));
}

std::string safety_mode_message(double timestamp, std::uint8_t safety_mode)
{
  std::string message = begin_message(MessageType::safety_mode, timestamp);
  put_u32(message, 0);  // code
  put_u32(message, 0);  // argument
  put_u8(message, safety_mode);
  put_u32(message, no_data);
  put_u32(message, 0);
  return finish_message(std::move(message));
}

std::string request_value_message(const LogEntry & entry)
{
  std::string message = begin_message(MessageType::request_value, entry.timestamp);
  put_u32(message, static_cast<std::uint32_t>(entry.number));
  put_u32(message, entry.requested_type);
  message += entry.text;
  return finish_message(std::move(message));
}

std::string popup_message(const LogEntry & entry)
{
  const std::string title = entry.title.substr(0, 255);  // the length field has one byte
  std::string message = begin_message(MessageType::popup, entry.timestamp);
  put_u32(message, static_cast<std::uint32_t>(entry.number));
  put_u8(message, 0);  // requested type: none
  put_u8(message, entry.level == LogLevel::warning ? 1 : 0);
  put_u8(message, entry.level == LogLevel::error ? 1 : 0);
  put_u8(message, entry.blocking ? 1 : 0);
  put_u8(message, static_cast<std::uint8_t>(title.size()));
  message += title;
  // The text of the log entry starts with "<title>: ".
  message += entry.text.substr(std::min(entry.text.size(), entry.title.size() + 2));
  return finish_message(std::move(message));
}

std::string robot_message_for(const LogEntry & entry)
{
  switch (entry.kind) {
    case LogKind::program_started:
      return key_message(entry.timestamp, "PROGRAM_XXX_STARTED", entry.title);
    case LogKind::program_ended:
      return key_message(entry.timestamp, "PROGRAM_XXX_STOPPED", entry.title);
    case LogKind::popup:
      return popup_message(entry);
    case LogKind::value_request:
      return request_value_message(entry);
    case LogKind::error_code:
      return error_code_message(entry.timestamp, entry.code, entry.text);
    case LogKind::safety_mode:
      return safety_mode_message(entry.timestamp, entry.safety_mode);
    case LogKind::text:
      break;
  }
  if (entry.source == "textmsg") {
    return text_message(entry.timestamp, entry.text);
  }
  if (entry.source == "program" && entry.level == LogLevel::error) {
    return runtime_exception_message(entry.timestamp, entry.line, entry.column,
                                     entry.exception.empty() ? entry.text : entry.exception);
  }
  return {};
}

std::string robot_message_name(const LogEntry & entry)
{
  switch (entry.kind) {
    case LogKind::program_started:
      return "key message PROGRAM_XXX_STARTED";
    case LogKind::program_ended:
      return "key message PROGRAM_XXX_STOPPED";
    case LogKind::popup:
      return "popup message";
    case LogKind::value_request:
      return "request value message";
    case LogKind::error_code:
      return fmt::format("error code message C{}A{}", entry.code.code, entry.code.argument);
    case LogKind::safety_mode:
      return fmt::format("safety mode message {}", entry.safety_mode);
    case LogKind::text:
      break;
  }
  return entry.source == "textmsg" ? "text message" : "runtime exception message";
}

}  // namespace ur_simulator::primary
