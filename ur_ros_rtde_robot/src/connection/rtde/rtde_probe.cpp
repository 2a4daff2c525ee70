#include "connection/rtde/rtde_probe.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "connection/big_endian.hpp"
#include "connection/ports.hpp"
#include "connection/rtde/rtde_header.hpp"

namespace ur_ros_rtde {
namespace {

constexpr char request_protocol_version = 'V';
constexpr char get_urcontrol_version = 'v';
constexpr char text_message = 'M';
/// Longest accepted package. The answers to the two requests are shorter.
constexpr std::size_t longest_package = 2048;

Error not_rtde(const std::string & address, const std::string & why)
{
  return {ErrorCode::link_lost, fmt::format("{}:{} accepts connections but does not answer as the RTDE "
                                            "server of a UR controller ({}): check the "
                                            "robot's address",
                                            address, rtde_port, why)};
}

Expected<std::vector<std::byte>> reply(TcpSocket & socket, const std::string & address, char type,
                                       TcpSocket::Clock::time_point deadline)
{
  while (TcpSocket::Clock::now() < deadline) {
    std::array<std::byte, rtde_header_size> header{};
    if (const auto status = socket.read(header, deadline); !status) {
      return tl::unexpected(not_rtde(address, status.error().message));
    }
    const std::size_t size = big_endian(std::span(header).first(2));
    const auto found = static_cast<char>(header[2]);
    if (size < rtde_header_size || size > longest_package || (found != type && found != text_message)) {
      return tl::unexpected(not_rtde(address, "its answer is not an RTDE package"));
    }
    std::vector<std::byte> body(size - rtde_header_size);
    if (const auto status = socket.read(body, deadline); !status) {
      return tl::unexpected(not_rtde(address, status.error().message));
    }
    if (found == type) {
      return body;
    }
  }
  return tl::unexpected(not_rtde(address, "it sends text messages instead of an answer"));
}

}  // namespace

Expected<ControllerVersion> probe_rtde(const std::string & address, std::chrono::milliseconds timeout)
{
  auto socket = TcpSocket::connect(address, rtde_port, timeout);
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  return probe_rtde(std::move(*socket), address, timeout);
}

Expected<ControllerVersion> probe_rtde(TcpSocket socket, const std::string & address,
                                       std::chrono::milliseconds timeout)
{
  const auto deadline = TcpSocket::Clock::now() + timeout;
  constexpr std::array version_2{std::byte{0}, std::byte{5}, std::byte{request_protocol_version},
                                 std::byte{0}, std::byte{2}};
  if (const auto status = socket.write(version_2, deadline); !status) {
    return tl::unexpected(status.error());
  }
  const auto accepted = reply(socket, address, request_protocol_version, deadline);
  if (!accepted) {
    return tl::unexpected(accepted.error());
  }
  if (accepted->size() != 1 || accepted->front() != std::byte{1}) {
    return tl::unexpected(
        not_rtde(address, "it rejects protocol version 2, which PolyScope has had since 3.3"));
  }
  constexpr std::array version{std::byte{0}, std::byte{3}, std::byte{get_urcontrol_version}};
  if (const auto status = socket.write(version, deadline); !status) {
    return tl::unexpected(status.error());
  }
  const auto numbers = reply(socket, address, get_urcontrol_version, deadline);
  if (!numbers) {
    return tl::unexpected(numbers.error());
  }
  if (numbers->size() < 16) {
    return tl::unexpected(not_rtde(address, "its answer does not contain a version"));
  }
  const auto number = [&](std::size_t i) {
    return static_cast<unsigned>(big_endian(std::span(*numbers).subspan(4 * i, 4)));
  };
  return ControllerVersion{number(0), number(1), number(2), number(3)};
}

Status probe_dashboard(TcpSocket socket, const std::string & address, std::chrono::milliseconds timeout)
{
  const auto greeting = socket.read_line(TcpSocket::Clock::now() + timeout);
  if (!greeting || greeting->find("Dashboard Server") == std::string::npos) {
    return failure(
        ErrorCode::link_lost,
        fmt::format("{}:{} accepts connections but does not greet as a UR dashboard server ({}): check the "
                    "robot's address",
                    address, dashboard_port, greeting ? "`" + *greeting + "`" : greeting.error().message));
  }
  return {};
}

std::string to_string(const ControllerVersion & version)
{
  return fmt::format("{}.{}.{}", version.major, version.minor, version.bugfix);
}

Status has_dashboard_server(const std::optional<ControllerVersion> & version)
{
  if (!version || !version->is_polyscope_x()) {
    return {};
  }
  return failure(
      ErrorCode::not_supported,
      fmt::format("the controller has PolyScope {}: PolyScope X has no dashboard server, which this driver "
                  "needs. Use a robot with PolyScope 5 or 3 (docs/use/polyscope_x.md)",
                  to_string(*version)));
}

}  // namespace ur_ros_rtde
