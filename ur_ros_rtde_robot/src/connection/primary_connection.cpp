#include "connection/primary_connection.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <utility>

#include "connection/big_endian.hpp"
#include "connection/ports.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

// UR, "Client Interface": size, type, timestamp (uint64), source, message type.
constexpr std::size_t shortest_package = 5;
constexpr std::size_t longest_primary_package = 1U << 20U;
constexpr std::size_t message_header = 15;
constexpr std::uint8_t robot_state = 16;
constexpr std::uint8_t robot_message = 20;

enum class MessageKind : std::uint8_t { text = 0, key = 7, runtime_exception = 10 };

std::string text_of(std::span<const std::byte> data)
{
  std::string text;
  for (const std::byte byte : data) {
    text.push_back(static_cast<char>(byte));
  }
  while (!text.empty() && (text.back() == '\0' || text.back() == '\n')) {
    text.pop_back();
  }
  return printable(text);
}

/// "syntax_error_on_line:4:…", "… failed in line 4: …"
int line_in(std::string_view text)
{
  const auto found = text.find("line");
  if (found == std::string_view::npos) {
    return 0;
  }
  auto digit = found + 5;  // after a blank or colon
  int line = 0;
  while (digit < text.size() && std::isdigit(static_cast<unsigned char>(text[digit])) != 0 &&
         line < 1'000'000) {
    line = 10 * line + (text[digit++] - '0');
  }
  return line;
}

std::optional<PrimaryMessage> key_message(std::span<const std::byte> body)
{
  constexpr std::size_t title_begin = 9;  // after code, argument and length of the title
  if (body.size() < title_begin) {
    return std::nullopt;
  }
  const auto title_size = std::to_integer<std::size_t>(body[title_begin - 1]);
  if (body.size() < title_begin + title_size) {
    return std::nullopt;
  }
  const std::string title = text_of(body.subspan(title_begin, title_size));
  std::string name = text_of(body.subspan(title_begin + title_size));
  if (title == "PROGRAM_XXX_STARTED") {
    return PrimaryMessage{PrimaryMessage::Kind::program_started, std::move(name)};
  }
  if (title == "PROGRAM_XXX_STOPPED") {
    return PrimaryMessage{PrimaryMessage::Kind::program_stopped, std::move(name)};
  }
  return std::nullopt;
}

std::optional<PrimaryMessage> exception_message(std::span<const std::byte> body)
{
  constexpr std::size_t text_begin = 8;  // after line and column
  if (body.size() < text_begin) {
    return std::nullopt;
  }
  PrimaryMessage message{PrimaryMessage::Kind::error, text_of(body.subspan(text_begin))};
  const auto line = static_cast<std::int32_t>(big_endian(body.first(4)));
  message.line = line > 0 ? line : line_in(message.text);
  return message;
}

std::optional<PrimaryMessage> message_of(std::span<const std::byte> package)
{
  if (package.size() < message_header || std::to_integer<std::uint8_t>(package[4]) != robot_message) {
    return std::nullopt;
  }
  const auto body = package.subspan(message_header);
  switch (MessageKind{std::to_integer<std::uint8_t>(package[message_header - 1])}) {
    case MessageKind::text:
      return PrimaryMessage{PrimaryMessage::Kind::text, text_of(body)};
    case MessageKind::key:
      return key_message(body);
    case MessageKind::runtime_exception:
      return exception_message(body);
  }
  return std::nullopt;
}

/// The robot state consists of packages with a total size and a type each.
std::optional<std::int32_t> robot_type_of(std::span<const std::byte> package)
{
  constexpr std::size_t header = 5;
  constexpr std::uint8_t configuration = 6;
  // Limits and motion limits of six joints, five defaults, DH parameters of six joints, two type numbers.
  constexpr std::size_t type_begin = header + 8 * (12 + 12 + 5 + 24) + 4 * 2;
  if (package.size() < header || std::to_integer<std::uint8_t>(package[4]) != robot_state) {
    return std::nullopt;
  }
  for (auto rest = package.subspan(header); rest.size() >= header;) {
    const std::size_t size = big_endian(rest.first(4));
    if (size < header || size > rest.size()) {
      break;
    }
    if (std::to_integer<std::uint8_t>(rest[4]) == configuration && size >= type_begin + 4) {
      return static_cast<std::int32_t>(big_endian(rest.subspan(type_begin, 4)));
    }
    rest = rest.subspan(size);
  }
  return std::nullopt;
}

}  // namespace

bool PrimaryReader::feed(std::span<const std::byte> bytes)
{
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  std::span<const std::byte> rest(buffer_);
  while (rest.size() >= shortest_package) {
    const std::size_t size = big_endian(rest.first(4));
    if (size < shortest_package || size > longest_primary_package) {
      return false;
    }
    if (rest.size() < size) {
      break;
    }
    if (auto message = message_of(rest.first(size))) {
      messages_.push_back(std::move(*message));
    }
    if (const auto type = robot_type_of(rest.first(size))) {
      robot_type_ = type;
    }
    rest = rest.subspan(size);
  }
  buffer_.erase(buffer_.begin(), buffer_.end() - static_cast<std::ptrdiff_t>(rest.size()));
  return true;
}

std::optional<PrimaryMessage> PrimaryReader::next()
{
  if (messages_.empty()) {
    return std::nullopt;
  }
  PrimaryMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

Expected<PrimaryConnection> PrimaryConnection::connect(const std::string & address,
                                                       std::chrono::milliseconds limit)
{
  auto socket = TcpSocket::connect(address, primary_port, limit);
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  PrimaryConnection connection(std::move(*socket));
  const auto greeting = connection.read(limit);
  if (!greeting) {
    return tl::unexpected(greeting.error());
  }
  if (*greeting == 0) {
    return failure(ErrorCode::link_lost, address + ": the primary interface (port 30001) does not answer");
  }
  return connection;
}

Status PrimaryConnection::send(std::string_view script, std::chrono::milliseconds limit)
{
  return socket_.write(script, TcpSocket::Clock::now() + limit);
}

Expected<std::size_t> PrimaryConnection::read(std::chrono::milliseconds wait)
{
  std::array<std::byte, 4096> bytes{};
  const auto got = socket_.read_some(bytes, TcpSocket::Clock::now() + wait);
  if (got && !reader_.feed(std::span(bytes).first(*got))) {
    return failure(ErrorCode::link_lost, "port 30001 does not follow the protocol of the primary interface");
  }
  return got;
}

Expected<std::int32_t> PrimaryConnection::robot_type(std::chrono::milliseconds limit)
{
  const auto deadline = TcpSocket::Clock::now() + limit;
  while (!reader_.robot_type()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - TcpSocket::Clock::now());
    if (left <= std::chrono::milliseconds(0)) {
      return failure(ErrorCode::timeout,
                     fmt::format("port {} did not send the configuration of the robot", primary_port));
    }
    if (const auto got = read(left); !got) {
      return tl::unexpected(got.error());
    }
  }
  return *reader_.robot_type();
}

Expected<std::optional<PrimaryMessage>> PrimaryConnection::next(std::chrono::milliseconds wait)
{
  auto message = reader_.next();
  if (!message) {
    if (const auto got = read(wait); !got) {
      return tl::unexpected(got.error());
    }
    message = reader_.next();
  }
  return message;
}

}  // namespace ur_ros_rtde
