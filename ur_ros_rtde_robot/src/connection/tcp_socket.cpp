#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <mutex>
#include <system_error>
#include <utility>

namespace ur_ros_rtde {
namespace {

std::string system_text(int error)
{
  return std::generic_category().message(error);
}

/// IPv4 only, like ur_rtde. Blocks until the name server answers.
Expected<in_addr> look_up(const std::string & name)
{
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo * found = nullptr;
  if (const int error = getaddrinfo(name.c_str(), nullptr, &hints, &found); error != 0) {
    return failure(ErrorCode::link_lost,
                   fmt::format("the address `{}` cannot be resolved ({}): check the robot's address", name,
                               gai_strerror(error)));
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo *)> keep(found, freeaddrinfo);
  sockaddr_in result{};
  std::copy_n(reinterpret_cast<const char *>(found->ai_addr), sizeof(result),
              reinterpret_cast<char *>(&result));
  return result.sin_addr;
}

/// A host name is resolved once per process, so that later connections, such as that of the last-resort stop,
/// never wait for a name server.
Expected<in_addr> resolve(const std::string & address)
{
  in_addr number{};
  if (inet_pton(AF_INET, address.c_str(), &number) == 1) {
    return number;
  }
  static std::mutex mutex;
  static std::map<std::string, in_addr> known;  // guarded by mutex
  {
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(address); found != known.end()) {
      return found->second;
    }
  }
  auto found = look_up(address);
  if (found) {
    const std::lock_guard lock(mutex);
    known.emplace(address, *found);
  }
  return found;
}

int milliseconds_to(TcpSocket::Clock::time_point deadline)
{
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - TcpSocket::Clock::now()).count();
  return static_cast<int>(std::clamp<std::chrono::milliseconds::rep>(left, 0, 60'000));
}

}  // namespace

TcpSocket::TcpSocket(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}

TcpSocket::TcpSocket(TcpSocket && other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), name_(std::move(other.name_))
{
}

TcpSocket & TcpSocket::operator=(TcpSocket && other) noexcept
{
  std::swap(descriptor_, other.descriptor_);
  std::swap(name_, other.name_);
  return *this;
}

TcpSocket::~TcpSocket()
{
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

Expected<TcpSocket> TcpSocket::connect(const std::string & address, std::uint16_t port,
                                       std::chrono::milliseconds timeout)
{
  const auto ip = resolve(address);
  if (!ip) {
    return tl::unexpected(ip.error());
  }
  sockaddr_in target{};
  target.sin_family = AF_INET;
  target.sin_addr = *ip;
  target.sin_port = htons(port);
  const auto deadline = Clock::now() + timeout;
  TcpSocket socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0),
                   fmt::format("{}:{}", address, port));
  const auto refused = [&](int error) {
    const char * remedy =
        error == ECONNREFUSED
            ? ": check the address, that the robot has started, and that this interface is enabled (on the "
              "pendant: Settings, Security, Services)"
            : "";
    return failure(ErrorCode::link_lost,
                   fmt::format("no connection to {}: {}{}", socket.name_, system_text(error), remedy));
  };
  if (socket.descriptor_ < 0) {
    return refused(errno);
  }
  const int on = 1;
  ::setsockopt(socket.descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  if (::connect(socket.descriptor_, reinterpret_cast<const sockaddr *>(&target), sizeof(target)) != 0) {
    if (errno != EINPROGRESS) {
      return refused(errno);
    }
    if (!socket.wait_for(POLLOUT, deadline)) {
      return failure(ErrorCode::link_lost, fmt::format("no connection to {}: no answer within {} ms: check "
                                                       "the address, and that the robot is on",
                                                       socket.name_, timeout.count()));
    }
    int error = 0;
    socklen_t size = sizeof(error);
    ::getsockopt(socket.descriptor_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) {
      return refused(error);
    }
  }
  return socket;
}

Status TcpSocket::wait_for(short events, Clock::time_point deadline) const
{
  pollfd descriptor{descriptor_, events, 0};
  int ready = 0;
  do {
    ready = ::poll(&descriptor, 1, milliseconds_to(deadline));
  } while (ready < 0 && errno == EINTR);
  if (ready > 0) {
    return {};
  }
  return failure(ErrorCode::link_lost, fmt::format("{} does not answer", name_));
}

void TcpSocket::shut_down_writing() const
{
  ::shutdown(descriptor_, SHUT_WR);
}

Status TcpSocket::write(std::span<const std::byte> data, Clock::time_point deadline)
{
  while (!data.empty()) {
    const auto sent = ::send(descriptor_, data.data(), data.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      data = data.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (auto ready = wait_for(POLLOUT, deadline); !ready) {
        return ready;
      }
    } else if (errno != EINTR) {
      return failure(ErrorCode::link_lost, fmt::format("{}: {}", name_, system_text(errno)));
    }
  }
  return {};
}

Status TcpSocket::write(std::string_view text, Clock::time_point deadline)
{
  return write(std::as_bytes(std::span(text.data(), text.size())), deadline);
}

Status TcpSocket::read(std::span<std::byte> data, Clock::time_point deadline)
{
  while (!data.empty()) {
    if (auto ready = wait_for(POLLIN, deadline); !ready) {
      return ready;
    }
    const auto got = ::recv(descriptor_, data.data(), data.size(), 0);
    if (got > 0) {
      data = data.subspan(static_cast<std::size_t>(got));
    } else if (got == 0) {
      return failure(ErrorCode::link_lost, fmt::format("{} closed the connection", name_));
    } else if (errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) {
      return failure(ErrorCode::link_lost, fmt::format("{}: {}", name_, system_text(errno)));
    }
  }
  return {};
}

Expected<std::size_t> TcpSocket::read_some(std::span<std::byte> data, Clock::time_point deadline)
{
  while (wait_for(POLLIN, deadline)) {
    const auto got = ::recv(descriptor_, data.data(), data.size(), 0);
    if (got > 0) {
      return static_cast<std::size_t>(got);
    }
    if (got == 0) {
      return failure(ErrorCode::link_lost, fmt::format("{} closed the connection", name_));
    }
    if (errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) {
      return failure(ErrorCode::link_lost, fmt::format("{}: {}", name_, system_text(errno)));
    }
  }
  return 0;
}

Expected<std::string> TcpSocket::read_line(Clock::time_point deadline)
{
  std::string line;
  while (line.size() < 1000) {
    std::byte character{};
    if (auto status = read(std::span(&character, 1), deadline); !status) {
      return tl::unexpected(status.error());
    }
    if (character == std::byte{'\n'}) {
      return line;
    }
    line.push_back(static_cast<char>(character));
  }
  return failure(ErrorCode::link_lost, fmt::format("{} sent 1,000 bytes without an end of line", name_));
}

}  // namespace ur_ros_rtde
