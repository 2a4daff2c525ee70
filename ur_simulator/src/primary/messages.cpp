#include "primary/messages.hpp"

#include "primary/big_endian.hpp"

namespace ur_simulator::primary {
namespace {

constexpr std::uint8_t robot_message = 20;

enum class MessageType : std::uint8_t { text = 0, version = 3, runtime_exception = 10 };

std::string begin(MessageType type, double timestamp)
{
  std::string message;
  put_u32(message, 0);  // the size, when it is known
  put_u8(message, robot_message);
  put_u64(message, static_cast<std::uint64_t>(timestamp * 1e6));
  put_u8(message, 0xff);  // source: -1, the controller
  put_u8(message, static_cast<std::uint8_t>(type));
  return message;
}

std::string finish(std::string message)
{
  std::string size;
  put_u32(size, static_cast<std::uint32_t>(message.size()));
  return message.replace(0, size.size(), size);
}

}  // namespace

std::string version_message(const PolyscopeVersion & version)
{
  constexpr std::string_view project = "URControl";
  std::string message = begin(MessageType::version, 0.0);
  put_u8(message, static_cast<std::uint8_t>(project.size()));
  message += project;
  put_u8(message, static_cast<std::uint8_t>(version.major));
  put_u8(message, static_cast<std::uint8_t>(version.minor));
  put_u32(message, version.bugfix);
  put_u32(message, version.build);
  message += "01-01-2025, 00:00:00";
  return finish(std::move(message));
}

std::string text_message(double timestamp, std::string_view text)
{
  std::string message = begin(MessageType::text, timestamp);
  message += text;
  return finish(std::move(message));
}

std::string runtime_exception_message(double timestamp, std::int32_t line, std::int32_t column,
                                      std::string_view text)
{
  std::string message = begin(MessageType::runtime_exception, timestamp);
  put_u32(message, static_cast<std::uint32_t>(line));
  put_u32(message, static_cast<std::uint32_t>(column));
  message += text;
  return finish(std::move(message));
}

std::string message_for(const LogEntry & entry)
{
  if (entry.source == "textmsg") {
    return text_message(entry.timestamp, entry.text);
  }
  if (entry.source == "program" && entry.level == LogLevel::error) {
    return runtime_exception_message(entry.timestamp, -1, -1, entry.text);
  }
  return {};
}

}  // namespace ur_simulator::primary
