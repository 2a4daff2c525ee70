#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace ur_fuzz {

/// The loopback address that the test runner reserves for this process.
inline std::string test_address()
{
  const char * address = std::getenv("UR_TEST_ADDRESS");
  return address == nullptr ? "127.0.0.1" : address;
}

/// A TCP server which sends each client the same bytes. Then it sends the end of the stream, and ignores what
/// the client sends; or, if it has one, its answer to the first bytes of the client.
class ReplyServer {
 public:
  /// Port 0 selects a free port.
  ReplyServer(const std::string & ip_address, std::uint16_t port)
      : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0))
  {
    const int on = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    ::inet_pton(AF_INET, ip_address.c_str(), &address.sin_addr);
    socklen_t size = sizeof(address);
    if (::bind(listener_, reinterpret_cast<sockaddr *>(&address), size) != 0 ||
        ::listen(listener_, 16) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr *>(&address), &size) != 0) {
      throw std::system_error(errno, std::generic_category(), "port of the reply server");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this] { serve(); });
  }
  ~ReplyServer()
  {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
  }
  ReplyServer(const ReplyServer &) = delete;
  ReplyServer & operator=(const ReplyServer &) = delete;

  std::uint16_t port() const { return port_; }
  void set_reply(std::string bytes, std::string answer = {})
  {
    const std::lock_guard lock(mutex_);
    reply_ = std::move(bytes);
    answer_ = std::move(answer);
  }

 private:
  static void send(int client, const std::string & bytes)
  {
    if (!bytes.empty()) {
      (void)::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
  }
  void serve()
  {
    for (int client = ::accept(listener_, nullptr, nullptr); client >= 0;
         client = ::accept(listener_, nullptr, nullptr)) {
      // A reset instead of a close leaves no connection in the state TIME_WAIT.
      const linger reset{1, 0};
      ::setsockopt(client, SOL_SOCKET, SO_LINGER, &reset, sizeof(reset));
      std::string reply, answer;
      {
        const std::lock_guard lock(mutex_);
        reply = reply_;
        answer = answer_;
      }
      send(client, reply);
      if (answer.empty()) {
        ::shutdown(client, SHUT_WR);
      }
      std::array<char, 4096> requests;
      while (::recv(client, requests.data(), requests.size(), 0) > 0) {
        send(client, std::exchange(answer, {}));
      }
      ::close(client);
    }
  }

  int listener_;
  std::uint16_t port_ = 0;
  std::mutex mutex_;
  std::string reply_;
  std::string answer_;
  std::jthread thread_;
};

}  // namespace ur_fuzz
