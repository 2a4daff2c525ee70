#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include "tcp_client.hpp"

namespace ur_simulator::testing {

/// Sends the same bytes in a thread, until it is destroyed or the peer closes the connection.
class Flood {
 public:
  Flood(const std::string & address, std::uint16_t port, std::string_view bytes) : client_(address, port)
  {
    std::string block;
    while (block.size() < 64 * 1024) {
      block += bytes;
    }
    thread_ = std::thread([this, block] {
      try {
        while (!stopping_) {
          client_.send(block);
          sent_ += block.size();
        }
      } catch (const std::runtime_error &) {
        // The simulator has closed the connection.
      }
    });
  }
  ~Flood()
  {
    stopping_ = true;
    client_.shut_down_sending();
    thread_.join();
  }
  Flood(const Flood &) = delete;
  Flood & operator=(const Flood &) = delete;
  std::size_t sent() const { return sent_; }

 private:
  TcpClient client_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> sent_{0};
  std::thread thread_;
};

}  // namespace ur_simulator::testing
