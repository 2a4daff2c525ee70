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
#include <optional>
#include <string>
#include <string_view>

#include "client_log/client_log.hpp"

namespace ur_simulator {

/// A TCP connection with fault injection: stalls, delays and lost data. Not thread-safe: all functions and
/// callbacks run on the thread of the io_context. Sending never blocks: data that the kernel does not accept
/// is buffered up to `send_buffer_limit`.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  /// Receives the data in pieces of any size.
  using DataHandler = std::function<void(std::string_view)>;
  /// Called exactly once, after the connection has been closed by either side.
  using CloseHandler = std::function<void()>;

  Connection(boost::asio::ip::tcp::socket socket, std::uint64_t id, PeerLog log = {});

  void start(DataHandler on_data, CloseHandler on_close);
  /// Sends or buffers all bytes. Closes the connection if more than `send_buffer_limit` bytes are buffered.
  void send(std::string_view bytes);
  /// Sends all bytes, or none if earlier bytes are still buffered. Returns false if the bytes are dropped.
  bool send_or_drop(std::string_view bytes);
  /// Closes the connection and discards the buffered data. The client log states the reason.
  void close(std::string_view reason);
  /// Closes the connection after the buffered data has been sent. Until then, received data is discarded.
  void close_after_sending(std::string_view reason);
  /// Closes the connection with a TCP reset, as after a crash.
  void reset();
  /// A stalled connection neither reads nor writes but stays open, as if the cable were unplugged.
  void set_stalled(bool stalled);
  /// Keeps the connection open for sending when the peer has ended its direction.
  void allow_half_close() { half_close_allowed_ = true; }
  /// Whether the peer has ended its direction of a connection that may be half-closed.
  bool end_of_input() const { return end_of_input_; }
  /// Pauses or resumes reading. While it is paused, TCP slows the peer down.
  void set_reading_paused(bool paused);
  /// Delays all data in both directions from now on. 0 ends the delay.
  void set_delay(std::chrono::milliseconds delay) { delay_ = delay; }
  /// Discards the data of the next `count` reads.
  void discard_next_reads(std::uint64_t count) { reads_to_discard_ = count; }

  std::uint64_t id() const { return id_; }
  bool is_open() const { return open_; }
  /// Data has arrived that will be read next. If the peer has closed the connection since, sending a message
  /// fails, and the connection would be closed before.
  bool has_unread_data() const;
  /// Address and port of the peer: "127.0.0.1:43210"
  const std::string & remote_endpoint() const { return remote_endpoint_; }
  /// The peer in the client log. Protocols add their messages here.
  const PeerLog & log() const { return log_; }

  static constexpr std::size_t send_buffer_limit = 256 * 1024;

 private:
  enum class Direction { incoming, outgoing };

  /// Data whose delivery is delayed.
  struct DelayedData {
    std::chrono::steady_clock::time_point due;
    Direction direction;
    std::string bytes;
  };

  void read();
  void handle_read(const boost::system::error_code & error, std::size_t size);
  void deliver(std::string_view bytes);
  void write(std::string_view bytes);
  std::size_t write_to_socket(std::string_view bytes);
  void flush_when_writable();
  void flush(const boost::system::error_code & error);
  void handle_socket_error(const boost::system::error_code & error);
  void close_socket();
  void notify_closed();
  bool delays_data() const { return delay_.count() > 0 || !delayed_.empty(); }
  void delay(Direction direction, std::string_view bytes);
  void schedule_delayed_data();
  void process_delayed_data();

  boost::asio::ip::tcp::socket socket_;
  std::uint64_t id_;
  std::string remote_endpoint_;
  PeerLog log_;
  DataHandler on_data_;
  CloseHandler on_close_;
  /// Small, so that a client that floods the controller does not delay the control cycle: the data of one
  /// read is processed between two cycles.
  std::array<char, 2048> read_buffer_;
  std::string send_buffer_;
  bool open_ = true;
  bool reading_ = false;
  bool waiting_to_write_ = false;
  /// Set: the connection is closed with this reason after the buffered data has been sent.
  std::optional<std::string> close_after_sending_;
  bool stalled_ = false;
  bool reading_paused_ = false;
  bool half_close_allowed_ = false;
  bool end_of_input_ = false;
  std::chrono::milliseconds delay_{0};
  boost::asio::steady_timer delay_timer_;
  std::deque<DelayedData> delayed_;
  std::size_t delayed_bytes_ = 0;
  std::uint64_t reads_to_discard_ = 0;
};

}  // namespace ur_simulator
