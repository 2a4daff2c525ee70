#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// A TCP connection every step of which has a limit, except the first look-up of a host name: for looking at
/// an address before ur_rtde, whose constructors can block, is let near it, and for the dashboard command of
/// last resort. Errors are link_lost and name address and port.
class TcpStream {
 public:
  using Clock = std::chrono::steady_clock;

  static Expected<TcpStream> connect(const std::string & address, std::uint16_t port,
                                     std::chrono::milliseconds limit);
  TcpStream(TcpStream && other) noexcept;
  TcpStream & operator=(TcpStream && other) noexcept;
  TcpStream(const TcpStream &) = delete;
  TcpStream & operator=(const TcpStream &) = delete;
  ~TcpStream();

  Status write(std::span<const std::byte> data, Clock::time_point deadline);
  Status write(std::string_view text, Clock::time_point deadline);
  /// Exactly data.size() bytes.
  Status read(std::span<std::byte> data, Clock::time_point deadline);
  /// What has come, at most data.size() bytes, waiting for the first until the deadline: 0, if nothing came.
  Expected<std::size_t> read_some(std::span<std::byte> data, Clock::time_point deadline);
  /// Up to and without the line feed; at most 1,000 bytes.
  Expected<std::string> read_line(Clock::time_point deadline);

 private:
  TcpStream(int descriptor, std::string name);
  Status wait_for(short events, Clock::time_point deadline) const;

  int descriptor_ = -1;
  std::string name_;  ///< "address:port"
};

}  // namespace ur_ros_rtde
