#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "encoding.hpp"
#include "tcp_client.hpp"

namespace ur_simulator::testing {

/// The beginning of the payload of a data package: the recipe id.
inline std::string data_package_header(int recipe_id)
{
  return std::string(1, static_cast<char>(recipe_id));
}

/// An RTDE client that encodes the packages itself.
class RtdeClient {
 public:
  struct Package {
    char type;
    std::string payload;
  };

  explicit RtdeClient(const std::string & address, std::uint16_t port = 30004) : socket_(address, port) {}

  static std::string package(char type, std::string_view payload)
  {
    return encode_uint(payload.size() + 3, 2) + type + std::string(payload);
  }
  void send(char type, std::string_view payload) { socket_.send(package(type, payload)); }
  void send_raw(std::string_view bytes) { socket_.send(bytes); }
  Package receive()
  {
    const std::string header = socket_.receive(3);
    return {header[2], socket_.receive(decode_uint(header.substr(0, 2)) - 3)};
  }
  /// Returns the next package of this type; skips others.
  Package receive(char type)
  {
    for (Package next = receive();; next = receive()) {
      if (next.type == type) {
        return next;
      }
    }
  }
  /// Sends a package and returns the payload of the reply.
  std::string request(char type, std::string_view payload)
  {
    send(type, payload);
    return receive(type).payload;
  }
  bool negotiate(unsigned version) { return request('V', encode_uint(version, 2)) == "\1"; }
  std::string setup_outputs(double frequency, std::string_view names)
  {
    return request('O', encode_double(frequency) + std::string(names));
  }
  std::string setup_inputs(std::string_view names) { return request('I', names); }
  bool start() { return request('S', "") == "\1"; }
  TcpClient & socket() { return socket_; }

 private:
  TcpClient socket_;
};

}  // namespace ur_simulator::testing
