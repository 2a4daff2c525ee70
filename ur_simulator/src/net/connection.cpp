#include "net/connection.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <exception>
#include <utility>

namespace ur_simulator {
namespace asio = boost::asio;
using asio::ip::tcp;

Connection::Connection(tcp::socket socket, std::uint64_t id, PeerLog log)
    : socket_(std::move(socket)), id_(id), log_(std::move(log)), delay_timer_(socket_.get_executor())
{
  boost::system::error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  const tcp::endpoint remote = socket_.remote_endpoint(ignored);
  remote_endpoint_ = remote.address().to_string(ignored) + ":" + std::to_string(remote.port());
}

void Connection::start(DataHandler on_data, CloseHandler on_close)
{
  on_data_ = std::move(on_data);
  on_close_ = std::move(on_close);
  if (!open_) {
    notify_closed();
    return;
  }
  read();
}

// ---- reading

void Connection::read()
{
  if (reading_ || stalled_ || reading_paused_ || end_of_input_) {
    return;
  }
  reading_ = true;
  socket_.async_read_some(
      asio::buffer(read_buffer_),
      [self = shared_from_this()](const boost::system::error_code & error, std::size_t size) {
        self->reading_ = false;
        self->handle_read(error, size);
      });
}

bool Connection::has_unread_data() const
{
  boost::system::error_code ignored;
  return reading_ && socket_.available(ignored) > 0;
}

void Connection::handle_read(const boost::system::error_code & error, std::size_t size)
{
  if (!open_) {
    return;
  }
  if (error == asio::error::eof && half_close_allowed_) {
    end_of_input_ = true;
    return;
  }
  if (error && error != asio::error::operation_aborted) {  // set_stalled() aborts the read
    handle_socket_error(error);
    return;
  }
  if (size > 0) {
    const std::string_view bytes(read_buffer_.data(), size);
    if (reads_to_discard_ > 0) {
      --reads_to_discard_;
    } else if (delays_data()) {
      delay(Direction::incoming, bytes);
    } else {
      deliver(bytes);
    }
  }
  if (open_) {
    read();
  }
}

void Connection::deliver(std::string_view bytes)
{
  if (close_after_sending_) {
    return;
  }
  // An exception in a protocol handler closes this connection; the controller's thread continues.
  try {
    on_data_(bytes);
  } catch (const std::exception & error) {
    close(error.what());
  }
}

void Connection::set_reading_paused(bool paused)
{
  reading_paused_ = paused;
  if (!paused && open_) {
    read();
  }
}

// ---- writing

void Connection::send(std::string_view bytes)
{
  if (!open_ || close_after_sending_ || bytes.empty()) {
    return;
  }
  if (delays_data()) {
    delay(Direction::outgoing, bytes);
  } else {
    write(bytes);
  }
}

bool Connection::send_or_drop(std::string_view bytes)
{
  if (!open_ || close_after_sending_ || stalled_ || !send_buffer_.empty()) {
    return false;
  }
  if (delays_data()) {
    delay(Direction::outgoing, bytes);
    return true;
  }
  const std::size_t written = write_to_socket(bytes);
  if (written > 0 && written < bytes.size()) {
    send_buffer_.append(bytes.substr(written));
    flush_when_writable();
  }
  return written > 0;
}

void Connection::write(std::string_view bytes)
{
  const std::size_t written = send_buffer_.empty() && !stalled_ ? write_to_socket(bytes) : 0;
  if (!open_ || written == bytes.size()) {
    return;
  }
  if (send_buffer_.size() + bytes.size() - written > send_buffer_limit) {
    close("the peer does not read");
    return;
  }
  send_buffer_.append(bytes.substr(written));
  flush_when_writable();
}

std::size_t Connection::write_to_socket(std::string_view bytes)
{
  boost::system::error_code error;
  const std::size_t written = socket_.write_some(asio::buffer(bytes.data(), bytes.size()), error);
  if (error && error != asio::error::would_block && error != asio::error::try_again) {
    handle_socket_error(error);
  }
  return written;
}

void Connection::flush_when_writable()
{
  if (waiting_to_write_ || stalled_) {
    return;
  }
  waiting_to_write_ = true;
  socket_.async_wait(tcp::socket::wait_write,
                     [self = shared_from_this()](const boost::system::error_code & error) {
                       self->waiting_to_write_ = false;
                       self->flush(error);
                     });
}

void Connection::flush(const boost::system::error_code & error)
{
  if (!open_ || stalled_) {
    return;
  }
  if (!error) {
    send_buffer_.erase(0, write_to_socket(send_buffer_));
  } else if (error != asio::error::operation_aborted) {  // set_stalled() aborts the wait
    handle_socket_error(error);
  }
  if (!open_) {
    return;
  }
  if (!send_buffer_.empty()) {
    flush_when_writable();
  } else if (close_after_sending_ && delayed_.empty()) {
    close(*close_after_sending_);
  }
}

// ---- fault injection

void Connection::set_stalled(bool stalled)
{
  if (stalled_ == stalled || !open_) {
    return;
  }
  stalled_ = stalled;
  if (stalled) {
    boost::system::error_code ignored;
    socket_.cancel(ignored);
    return;
  }
  read();
  if (!send_buffer_.empty()) {
    flush_when_writable();
  }
}

void Connection::delay(Direction direction, std::string_view bytes)
{
  delayed_bytes_ += bytes.size();
  if (delayed_bytes_ > send_buffer_limit) {
    close("too much data is delayed");
    return;
  }
  // The order is kept, also after the delay has been reduced.
  const auto due = std::chrono::steady_clock::now() + delay_;
  delayed_.push_back(
      {delayed_.empty() ? due : std::max(due, delayed_.back().due), direction, std::string(bytes)});
  if (delayed_.size() == 1) {
    schedule_delayed_data();
  }
}

void Connection::schedule_delayed_data()
{
  delay_timer_.expires_at(delayed_.front().due);
  delay_timer_.async_wait([self = shared_from_this()](const boost::system::error_code & error) {
    if (!error) {
      self->process_delayed_data();
    }
  });
}

void Connection::process_delayed_data()
{
  const auto now = std::chrono::steady_clock::now();
  while (open_ && !delayed_.empty() && delayed_.front().due <= now) {
    // The entry is removed after its delivery, so that a reply to it is queued behind it.
    const Direction direction = delayed_.front().direction;
    const std::string bytes = std::move(delayed_.front().bytes);
    delayed_bytes_ -= bytes.size();
    direction == Direction::outgoing ? write(bytes) : deliver(bytes);
    delayed_.pop_front();
  }
  if (open_ && !delayed_.empty()) {
    schedule_delayed_data();
  } else if (open_ && close_after_sending_ && send_buffer_.empty()) {
    close(*close_after_sending_);
  }
}

// ---- closing

void Connection::close_after_sending(std::string_view reason)
{
  if (send_buffer_.empty() && delayed_.empty()) {
    close(reason);
  } else {
    close_after_sending_ = reason;
  }
}

void Connection::reset()
{
  boost::system::error_code ignored;
  socket_.set_option(asio::socket_base::linger(true, 0), ignored);
  close("reset");
}

void Connection::close(std::string_view reason)
{
  if (open_) {
    log_.closed_by_robot(reason);
    close_socket();
  }
}

void Connection::handle_socket_error(const boost::system::error_code & error)
{
  if (open_) {
    log_.closed_by_peer(error == asio::error::eof ? "closes the connection" : error.message());
    close_socket();
  }
}

void Connection::close_socket()
{
  open_ = false;
  boost::system::error_code ignored;
  delay_timer_.cancel();
  socket_.close(ignored);
  notify_closed();
}

void Connection::notify_closed()
{
  // Released after the call: the handler may own objects that own this connection.
  const CloseHandler on_close = std::exchange(on_close_, nullptr);
  if (on_close) {
    on_close();
  }
  log_ = {};
}

}  // namespace ur_simulator
