#include "connection/primary_connection.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
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

enum class MessageKind : std::uint8_t { text = 0, error_code = 6, key = 7, runtime_exception = 10 };

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

/// Code, argument, level, type of the data, data (int32 each), text. Lower levels are information and
/// warnings.
std::optional<PrimaryMessage> error_code_message(std::span<const std::byte> body)
{
  constexpr std::size_t text_begin = 20;
  constexpr std::uint64_t violation = 3;
  constexpr std::uint64_t fault = 4;
  if (body.size() < text_begin) {
    return std::nullopt;
  }
  const auto level = big_endian(body.subspan(8, 4));
  if (level != violation && level != fault) {
    return std::nullopt;
  }
  return PrimaryMessage{PrimaryMessage::Kind::error_code,
                        fmt::format("C{}A{}: {}", big_endian(body.first(4)), big_endian(body.subspan(4, 4)),
                                    text_of(body.subspan(text_begin)))};
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
    case MessageKind::error_code:
      return error_code_message(body);
    case MessageKind::key:
      return key_message(body);
    case MessageKind::runtime_exception:
      return exception_message(body);
  }
  return std::nullopt;
}

/// A package of the robot state: total size, type, content.
struct StatePackage {
  std::uint8_t type;
  std::span<const std::byte> content;
};

constexpr std::size_t state_package_header = 5;

/// Removes the first package of a robot state from `rest`; none at its end, or if its size is invalid.
std::optional<StatePackage> take_state_package(std::span<const std::byte> & rest)
{
  if (rest.size() < state_package_header) {
    return std::nullopt;
  }
  const std::size_t size = big_endian(rest.first(4));
  if (size < state_package_header || size > rest.size()) {
    return std::nullopt;
  }
  const StatePackage package{
      std::to_integer<std::uint8_t>(rest[4]),
      rest.subspan(state_package_header, size - state_package_header),
  };
  rest = rest.subspan(size);
  return package;
}

std::optional<std::int32_t> robot_type_of(std::span<const std::byte> configuration)
{
  // Limits and motion limits of six joints, five defaults, DH parameters of six joints, two version numbers.
  constexpr std::size_t type_begin = 8 * (12 + 12 + 5 + 24) + 4 * 2;
  if (configuration.size() < type_begin + 4) {
    return std::nullopt;
  }
  return static_cast<std::int32_t>(big_endian(configuration.subspan(type_begin, 4)));
}

double double_at(std::span<const std::byte> data, std::size_t index)
{
  return std::bit_cast<double>(big_endian(data.subspan(8 * index, 8)));
}

/// Six checksums, then theta, a, d and alpha of the six joints each.
std::optional<kinematics::DhRows> dh_rows_of(std::span<const std::byte> kinematics_data)
{
  constexpr std::size_t checksums = 4 * 6;
  constexpr std::size_t joints = 6;
  if (kinematics_data.size() < checksums + 8 * 4 * joints) {
    return std::nullopt;
  }
  const auto values = kinematics_data.subspan(checksums);
  kinematics::DhRows rows{};
  for (std::size_t i = 0; i < joints; ++i) {
    rows[i] = {double_at(values, i), double_at(values, joints + i), double_at(values, 2 * joints + i),
               double_at(values, 3 * joints + i)};
    if (!std::isfinite(rows[i].theta + rows[i].a + rows[i].d + rows[i].alpha)) {
      return std::nullopt;
    }
  }
  return rows;
}

std::optional<ArmData> arm_data_of(std::span<const std::byte> package)
{
  constexpr std::uint8_t kinematics_info = 5;
  constexpr std::uint8_t configuration = 6;
  if (package.size() < shortest_package || std::to_integer<std::uint8_t>(package[4]) != robot_state) {
    return std::nullopt;
  }
  std::optional<std::int32_t> type;
  std::optional<kinematics::DhRows> rows;
  auto rest = package.subspan(shortest_package);
  while (const auto part = take_state_package(rest)) {
    if (part->type == configuration) {
      type = robot_type_of(part->content);
    } else if (part->type == kinematics_info) {
      rows = dh_rows_of(part->content);
    }
  }
  return type ? std::optional<ArmData>({*type, rows}) : std::nullopt;
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
    if (const auto data = arm_data_of(rest.first(size))) {
      arm_data_ = data;
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
                                                       std::chrono::milliseconds timeout)
{
  auto socket = TcpSocket::connect(address, primary_port, timeout);
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  PrimaryConnection connection(std::move(*socket));
  const auto greeting = connection.read(timeout);
  if (!greeting) {
    return tl::unexpected(greeting.error());
  }
  if (*greeting == 0) {
    return failure(ErrorCode::link_lost, address + ": the primary interface (port 30001) does not answer");
  }
  return connection;
}

Status PrimaryConnection::send(std::string_view script, std::chrono::milliseconds timeout)
{
  return socket_.write(script, TcpSocket::Clock::now() + timeout);
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

Expected<ArmData> PrimaryConnection::arm_data(std::chrono::milliseconds timeout)
{
  const auto deadline = TcpSocket::Clock::now() + timeout;
  while (!reader_.arm_data()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - TcpSocket::Clock::now());
    if (left <= std::chrono::milliseconds(0)) {
      return failure(ErrorCode::timeout,
                     fmt::format("port {} did not send the configuration of the robot", primary_port));
    }
    if (const auto got = read(left); !got) {
      return tl::unexpected(got.error());
    }
  }
  return *reader_.arm_data();
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
