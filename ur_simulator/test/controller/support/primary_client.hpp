#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "encoding.hpp"
#include "tcp_client.hpp"

namespace ur_simulator::testing {

/// The sub-packages of a robot state by type, without size and type.
inline std::map<int, std::string> robot_state_packages(const std::string & message)
{
  std::map<int, std::string> packages;
  for (std::size_t begin = 1; begin < message.size();) {
    const std::size_t size = decode_uint(message.substr(begin, 4));
    packages[message[begin + 4]] = message.substr(begin + 5, size - 5);
    begin += size;
  }
  return packages;
}

/// A client of the primary (30001) or secondary (30002) interface.
class PrimaryClient {
 public:
  PrimaryClient(const std::string & address, std::uint16_t port) : socket_(address, port) {}

  /// Returns the next message, starting with the type byte.
  std::string receive_message() { return socket_.receive(decode_uint(socket_.receive(4)) - 4); }
  /// Returns the next message of a type (16 robot state, 20 robot message).
  std::string receive_message(char type)
  {
    for (;;) {
      std::string message = receive_message();
      if (message[0] == type) {
        return message;
      }
    }
  }
  /// Returns the next robot message of a type (0 text, 7 key, 10 runtime exception, …).
  std::string receive_robot_message(char robot_message_type)
  {
    for (;;) {
      std::string message = receive_message(20);
      if (message[10] == robot_message_type) {
        return message;
      }
    }
  }
  /// Returns the sub-packages of the next robot state by type, without size and type.
  std::map<int, std::string> receive_robot_state() { return robot_state_packages(receive_message(16)); }
  TcpClient & socket() { return socket_; }

 private:
  TcpClient socket_;
};

}  // namespace ur_simulator::testing
