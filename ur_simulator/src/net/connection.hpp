#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace ur_simulator {

/// One client on one socket. Single-threaded: everything happens on the io_context's thread. Sends never
/// block: what the kernel does not take waits in a bounded queue.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  /// Bytes as they came, in pieces of any size.
  using OnData = std::function<void(std::string_view)>;
  /// Called exactly once, when the connection has ended for whatever reason.
  using OnClose = std::function<void()>;

  Connection(boost::asio::ip::tcp::socket socket, std::uint64_t id);

  void start(OnData on_data, OnClose on_close);
  /// Sends all of it, now or as soon as the client reads; a client that has let more than `queue_limit` bytes
  /// pile up is disconnected.
  void send(std::string_view bytes);
  /// Sends all of it, or nothing when the client has not read what came before: then the caller's data is
  /// dropped.
  bool send_or_drop(std::string_view bytes);
  /// Ends the connection; what waits unsent is lost.
  void close();
  /// Ends it once everything queued has been sent.
  void close_after_sending();
  /// Ends it as a crashed peer would: with a reset instead of an orderly end.
  void reset();
  /// A stalled connection neither reads nor writes but stays open, as behind a pulled cable.
  void stall(bool stalled);
  /// From now on everything, both ways, is this late, as over a bad line. 0: no more.
  void delay(std::chrono::milliseconds by);
  /// The next `pieces` that arrive are lost, as if they had never been sent.
  void lose(std::uint64_t pieces) { to_lose_ = pieces; }

  std::uint64_t id() const { return id_; }
  bool open() const { return open_; }
  bool backed_up() const { return !queue_.empty(); }
  /// "127.0.0.1:43210"
  const std::string & peer() const { return peer_; }

  static constexpr std::size_t queue_limit = 256 * 1024;

 private:
  void read();
  void take(const boost::system::error_code & error, std::size_t size);
  void deliver(std::string_view bytes);
  std::size_t write_now(std::string_view bytes);
  void flush_when_writable();
  void finish();
  void write(std::string_view bytes);
  /// Keeps what was sent or received until its time has come.
  void keep(bool outgoing, std::string_view bytes);
  void wait_for_kept();
  void release_kept();

  /// Bytes on their way over a bad line.
  struct Late {
    std::chrono::steady_clock::time_point due;
    bool outgoing;
    std::string bytes;
  };

  boost::asio::ip::tcp::socket socket_;
  std::uint64_t id_;
  std::string peer_;
  OnData on_data_;
  OnClose on_close_;
  std::array<char, 16384> received_;
  std::string queue_;
  bool open_ = true;
  bool reading_ = false;
  bool waiting_to_write_ = false;
  bool closing_ = false;
  bool stalled_ = false;
  std::chrono::milliseconds delay_{0};
  boost::asio::steady_timer late_timer_;
  std::deque<Late> late_;
  std::size_t late_bytes_ = 0;
  std::uint64_t to_lose_ = 0;
};

}  // namespace ur_simulator
