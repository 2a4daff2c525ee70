#include "net/connection.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <exception>
#include <utility>

namespace ur_simulator {
namespace asio = boost::asio;
using asio::ip::tcp;

Connection::Connection(tcp::socket socket, std::uint64_t id)
    : socket_(std::move(socket)), id_(id), late_timer_(socket_.get_executor())
{
  boost::system::error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  const tcp::endpoint peer = socket_.remote_endpoint(ignored);
  peer_ = peer.address().to_string(ignored) + ":" + std::to_string(peer.port());
}

void Connection::start(OnData on_data, OnClose on_close)
{
  on_data_ = std::move(on_data);
  on_close_ = std::move(on_close);
  if (!open_) {
    finish();
    return;
  }
  read();
}

void Connection::read()
{
  if (reading_ || stalled_) {
    return;
  }
  reading_ = true;
  socket_.async_read_some(
      asio::buffer(received_),
      [self = shared_from_this()](const boost::system::error_code & error, std::size_t size) {
        self->reading_ = false;
        self->take(error, size);
      });
}

void Connection::take(const boost::system::error_code & error, std::size_t size)
{
  if (!open_) {
    return;
  }
  if (error && error != asio::error::operation_aborted) {  // aborted: by stall()
    close();
    return;
  }
  if (size > 0) {
    const std::string_view bytes(received_.data(), size);
    if (to_lose_ > 0) {
      --to_lose_;
    } else if (delay_.count() > 0 || !late_.empty()) {
      keep(false, bytes);
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
  // A defect in one protocol handler costs that client its connection, never the controller its thread.
  try {
    on_data_(bytes);
  } catch (const std::exception &) {
    close();
  }
}

std::size_t Connection::write_now(std::string_view bytes)
{
  boost::system::error_code error;
  const std::size_t written = socket_.write_some(asio::buffer(bytes.data(), bytes.size()), error);
  if (error && error != asio::error::would_block && error != asio::error::try_again) {
    close();
  }
  return written;
}

void Connection::send(std::string_view bytes)
{
  if (!open_ || closing_ || bytes.empty()) {
    return;
  }
  if (delay_.count() > 0 || !late_.empty()) {
    keep(true, bytes);
  } else {
    write(bytes);
  }
}

void Connection::write(std::string_view bytes)
{
  const std::size_t written = queue_.empty() && !stalled_ ? write_now(bytes) : 0;
  if (!open_ || written == bytes.size()) {
    return;
  }
  if (queue_.size() + bytes.size() - written > queue_limit) {
    close();
    return;
  }
  queue_.append(bytes.substr(written));
  flush_when_writable();
}

bool Connection::send_or_drop(std::string_view bytes)
{
  if (!open_ || closing_ || stalled_ || !queue_.empty()) {
    return false;
  }
  if (delay_.count() > 0 || !late_.empty()) {
    keep(true, bytes);
    return true;
  }
  const std::size_t written = write_now(bytes);
  if (written > 0 && written < bytes.size()) {
    queue_.append(bytes.substr(written));
    flush_when_writable();
  }
  return written > 0;
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
                       if (error || !self->open_ || self->stalled_) {
                         return;
                       }
                       self->queue_.erase(0, self->write_now(self->queue_));
                       if (!self->open_) {
                         return;
                       }
                       if (!self->queue_.empty()) {
                         self->flush_when_writable();
                       } else if (self->closing_) {
                         self->close();
                       }
                     });
}

void Connection::delay(std::chrono::milliseconds by)
{
  delay_ = by;
}

void Connection::keep(bool outgoing, std::string_view bytes)
{
  late_bytes_ += bytes.size();
  if (late_bytes_ > queue_limit) {
    close();
    return;
  }
  // Never before what was sent earlier, also when the delay has become shorter.
  const auto due = std::chrono::steady_clock::now() + delay_;
  late_.push_back({late_.empty() ? due : std::max(due, late_.back().due), outgoing, std::string(bytes)});
  if (late_.size() == 1) {
    wait_for_kept();
  }
}

void Connection::wait_for_kept()
{
  late_timer_.expires_at(late_.front().due);
  late_timer_.async_wait([self = shared_from_this()](const boost::system::error_code & error) {
    if (!error) {
      self->release_kept();
    }
  });
}

void Connection::release_kept()
{
  const auto now = std::chrono::steady_clock::now();
  while (open_ && !late_.empty() && late_.front().due <= now) {
    // What is delivered may be answered: that comes after it, hence it stays in the queue meanwhile.
    const bool outgoing = late_.front().outgoing;
    const std::string bytes = std::move(late_.front().bytes);
    late_bytes_ -= bytes.size();
    outgoing ? write(bytes) : deliver(bytes);
    late_.pop_front();
  }
  if (open_ && !late_.empty()) {
    wait_for_kept();
  } else if (open_ && closing_ && queue_.empty()) {
    close();
  }
}

void Connection::close_after_sending()
{
  if (queue_.empty() && late_.empty()) {
    close();
  } else {
    closing_ = true;
  }
}

void Connection::reset()
{
  boost::system::error_code ignored;
  socket_.set_option(asio::socket_base::linger(true, 0), ignored);
  close();
}

void Connection::stall(bool stalled)
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
  if (!queue_.empty()) {
    flush_when_writable();
  }
}

void Connection::close()
{
  if (!open_) {
    return;
  }
  open_ = false;
  boost::system::error_code ignored;
  late_timer_.cancel();
  socket_.close(ignored);
  finish();
}

void Connection::finish()
{
  // Both callbacks may hold the session that holds this connection: let go of them.
  const OnClose on_close = std::exchange(on_close_, nullptr);
  if (on_close) {
    on_close();
  }
}

}  // namespace ur_simulator
