#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// A TCP connection whose operations all have a time limit, except for the first look-up of a host name. Used
/// to probe an address before calling ur_rtde's constructors, which can block, and for the dashboard command
/// that stops the arm as a last resort. Errors are link_lost and name address and port.
class TcpSocket {
 public:
  using Clock = std::chrono::steady_clock;

  static Expected<TcpSocket> connect(const std::string & address, std::uint16_t port,
                                     std::chrono::milliseconds timeout);
  TcpSocket(TcpSocket && other) noexcept;
  TcpSocket & operator=(TcpSocket && other) noexcept;
  TcpSocket(const TcpSocket &) = delete;
  TcpSocket & operator=(const TcpSocket &) = delete;
  ~TcpSocket();

  /// Nothing can be written afterwards. Does not wait; may be called by another thread.
  void shut_down_writing() const;

  Status write(std::span<const std::byte> data, Clock::time_point deadline);
  Status write(std::string_view text, Clock::time_point deadline);
  /// Reads exactly data.size() bytes.
  Status read(std::span<std::byte> data, Clock::time_point deadline);
  /// Reads the available bytes, at most data.size(), and waits for the first one until the deadline. 0 if
  /// none arrived.
  Expected<std::size_t> read_some(std::span<std::byte> data, Clock::time_point deadline);
  /// Reads up to the line feed, which is not returned; at most 1,000 bytes.
  Expected<std::string> read_line(Clock::time_point deadline);

 private:
  TcpSocket(int descriptor, std::string name);
  Status wait_for(short events, Clock::time_point deadline) const;

  int descriptor_ = -1;
  std::string name_;  ///< "address:port"
};

}  // namespace ur_ros_rtde
