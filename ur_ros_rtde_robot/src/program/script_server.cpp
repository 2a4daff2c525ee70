#include "program/script_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stop_token>
#include <system_error>
#include <utility>
#include <vector>

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view request = "request_program";
constexpr std::size_t max_request_size = 64;
constexpr std::size_t max_clients = 16;
/// The URCap waits 5 s for the first bytes and 0.5 s for more.
constexpr std::chrono::seconds client_timeout(10);
/// After a connection that cannot be accepted, for example because the process has too many open files.
constexpr std::chrono::milliseconds accept_pause(200);

class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  ~Descriptor()
  {
    if (value_ >= 0) {
      ::close(value_);
    }
  }
  Descriptor(Descriptor && other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor & operator=(Descriptor && other) noexcept
  {
    std::swap(value_, other.value_);
    return *this;
  }
  int get() const { return value_; }
  explicit operator bool() const { return value_ >= 0; }

 private:
  int value_;
};

struct Client {
  Descriptor socket;
  std::string name;
  std::string received;
  std::string to_send;
  Clock::time_point deadline;
};

Expected<Descriptor> listen_at(std::uint16_t port)
{
  Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(listener.get(), reinterpret_cast<const sockaddr *>(&address), sizeof(address)) == 0 &&
      ::listen(listener.get(), static_cast<int>(max_clients)) == 0) {
    return listener;
  }
  const int error = errno;
  if (error == EADDRINUSE) {
    return failure(
        ErrorCode::not_ready,
        fmt::format(
            "port {0}, at which the External Control URCap asks for the control program, is in use: "
            "end the program that uses it (`ss -ltnp sport = :{0}` names it; perhaps another driver), "
            "or choose another urcap_port, here and in the URCap's installation on the pendant",
            port));
  }
  return failure(ErrorCode::not_ready,
                 fmt::format("port {}, at which the External Control URCap asks for the control program, "
                             "cannot be opened ({}): choose another urcap_port, here and in the URCap's "
                             "installation on the pendant",
                             port, std::generic_category().message(error)));
}

bool connection_closed(ssize_t result)
{
  return result == 0 || (result < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

}  // namespace

/// The sockets with their input and output buffers.
class ScriptServer::Service {
 public:
  Service(ScriptServer & server, const std::stop_token & stop)
      : server_(server),
        wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        wake_on_stop_(stop, [this] { ::eventfd_write(wake_.get(), 1); })
  {
  }

  Status listen()
  {
    if (listener_) {
      return {};
    }
    auto listener = listen_at(server_.port_);
    if (!listener) {
      return tl::unexpected(listener.error());
    }
    listener_ = std::move(*listener);
    return {};
  }

  /// Waits for events up to `timeout` and handles them.
  void poll_once(std::chrono::milliseconds timeout)
  {
    const bool accepts = Clock::now() >= accept_after_;
    std::vector<pollfd> waiting{{wake_.get(), POLLIN, 0}, {accepts ? listener_.get() : -1, POLLIN, 0}};
    for (const Client & client : clients_) {
      waiting.push_back(
          {client.socket.get(), static_cast<short>(client.to_send.empty() ? POLLIN : POLLIN | POLLOUT), 0});
    }
    timeout = accepts ? timeout : std::min(timeout, accept_pause);
    if (::poll(waiting.data(), waiting.size(), static_cast<int>(timeout.count())) < 0) {
      return;
    }
    const auto now = Clock::now();
    std::size_t index = 2;
    std::erase_if(clients_, [&](Client & client) {
      const bool ready = waiting[index++].revents != 0;
      return (ready && !(receive(client) && send(client))) || now > client.deadline;
    });
    if ((waiting[1].revents & POLLIN) != 0) {
      accept();
    }
  }

 private:
  void accept()
  {
    sockaddr_in peer{};
    socklen_t size = sizeof(peer);
    Descriptor socket(
        ::accept4(listener_.get(), reinterpret_cast<sockaddr *>(&peer), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) {
      server_.logger_.log_on_change(LogLevel::error, fmt::format("cannot serve the control program: {}",
                                                                 std::generic_category().message(errno)));
      accept_after_ = Clock::now() + accept_pause;  // the connection keeps the listener ready
      return;
    }
    if (clients_.size() >= max_clients) {
      return;
    }
    std::array<char, INET_ADDRSTRLEN> text{};
    ::inet_ntop(AF_INET, &peer.sin_addr, text.data(), text.size());
    clients_.push_back({std::move(socket), text.data(), {}, {}, Clock::now() + client_timeout});
  }

  /// False if the connection has to be closed.
  bool receive(Client & client)
  {
    std::array<char, 128> bytes{};
    const auto got = ::recv(client.socket.get(), bytes.data(), bytes.size(), 0);
    if (connection_closed(got)) {
      return false;
    }
    client.received.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    for (auto end = client.received.find('\n'); end != std::string::npos; end = client.received.find('\n')) {
      auto answer = server_.answer(client.received.substr(0, end), client.name);
      if (!answer) {
        return false;
      }
      client.received.erase(0, end + 1);
      if (client.to_send.empty()) {
        client.to_send = std::move(*answer);
      }
    }
    return client.received.size() <= max_request_size;
  }

  bool send(Client & client)
  {
    if (client.to_send.empty()) {
      return true;
    }
    const auto sent = ::send(client.socket.get(), client.to_send.data(), client.to_send.size(), MSG_NOSIGNAL);
    if (connection_closed(sent)) {
      return false;
    }
    client.to_send.erase(0, static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
    return true;
  }

  ScriptServer & server_;
  Descriptor listener_;
  Clock::time_point accept_after_{};
  std::vector<Client> clients_;
  Descriptor wake_;
  std::stop_callback<std::function<void()>> wake_on_stop_;
};

ScriptServer::ScriptServer(std::uint16_t port, std::chrono::milliseconds retry_interval, Source source,
                           LogFunction log)
    : port_(port),
      retry_interval_(retry_interval),
      source_(std::move(source)),
      logger_(std::move(log)),
      status_(failure(ErrorCode::not_ready, fmt::format("port {} is not open yet", port)))
{
}

void ScriptServer::start()
{
  thread_ = std::jthread([this](const std::stop_token & stop) { run(stop); });
}

void ScriptServer::stop()
{
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
}

Status ScriptServer::status() const
{
  const std::lock_guard lock(mutex_);
  return status_;
}

unsigned ScriptServer::fetched() const
{
  const std::lock_guard lock(mutex_);
  return fetched_;
}

void ScriptServer::set(Status status)
{
  {
    const std::lock_guard lock(mutex_);
    if (status_.has_value() == status.has_value() &&
        (status || status_.error().message == status.error().message)) {
      return;
    }
    status_ = std::move(status);
  }
  if (status_function) {
    status_function();
  }
}

void ScriptServer::run(const std::stop_token & stop)
{
  Service service(*this, stop);
  while (!stop.stop_requested()) {
    try {
      set(service.listen());
      service.poll_once(retry_interval_);
    } catch (const std::exception & error) {
      logger_.log_on_change(LogLevel::error,
                            fmt::format("cannot serve the control program: {}", error.what()));
    }
  }
}

std::optional<std::string> ScriptServer::answer(const std::string & line, const std::string & peer)
{
  if (line.substr(0, line.find_last_not_of(" \r") + 1) != request) {
    logger_.log_on_change(LogLevel::warn,
                          fmt::format("{} asked port {} for something other than the control program: "
                                      "is it an External Control URCap?",
                                      peer, port_));
    return std::nullopt;
  }
  const auto version = source_.version();
  if (!version) {
    logger_.log(LogLevel::warn, fmt::format("{} asked for the control program before its controller was "
                                            "known: check the robot's address, and press play again",
                                            peer));
    return std::nullopt;
  }
  std::string program;
  try {
    program = source_.program(*version);
  } catch (const std::exception & error) {
    logger_.log(LogLevel::error, fmt::format("there is no control program for {}: {}", peer, error.what()));
    return std::nullopt;
  }
  {
    const std::lock_guard lock(mutex_);
    ++fetched_;
  }
  logger_.log(LogLevel::info, fmt::format("{} has fetched the control program", peer));
  return program;
}

}  // namespace ur_ros_rtde
