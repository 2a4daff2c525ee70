#include "net/text_request.hpp"

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <memory>
#include <utility>

namespace ur_simulator {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// One request. The pending asynchronous operations own it.
class TextRequest : public std::enable_shared_from_this<TextRequest> {
 public:
  TextRequest(asio::io_context & io, std::string_view request, TextReplyHandler on_reply,
              const TextRequestLimits & limits)
      : resolver_(io),
        socket_(io),
        timer_(io),
        request_(request),
        on_reply_(std::move(on_reply)),
        limits_(limits)
  {
  }

  void start(const std::string & host, std::uint16_t port)
  {
    start_timeout(limits_.connect_timeout, [](TextRequest & self) { self.fail("connect timed out"); });
    resolver_.async_resolve(
        host, std::to_string(port),
        [self = shared_from_this()](const error_code & error, const tcp::resolver::results_type & endpoints) {
          if (error) {
            self->fail(error.message());
          } else if (self->on_reply_) {
            self->connect(endpoints);
          }
        });
  }

 private:
  void connect(const tcp::resolver::results_type & endpoints)
  {
    asio::async_connect(socket_, endpoints,
                        [self = shared_from_this()](const error_code & error, const tcp::endpoint &) {
                          error ? self->fail(error.message()) : self->send_request();
                        });
  }

  void send_request()
  {
    if (!on_reply_) {
      return;
    }
    start_timeout(limits_.reply_timeout, [](TextRequest & self) { self.fail("nothing was received"); });
    asio::async_write(socket_, asio::buffer(request_),
                      [self = shared_from_this()](const error_code & error, std::size_t) {
                        error ? self->fail(error.message()) : self->read();
                      });
  }

  void read()
  {
    if (!on_reply_) {
      return;
    }
    socket_.async_read_some(asio::buffer(buffer_),
                            [self = shared_from_this()](const error_code & error, std::size_t size) {
                              self->handle_read(error, size);
                            });
  }

  void handle_read(const error_code & error, std::size_t size)
  {
    reply_.append(buffer_.data(), size);
    if (error) {
      reply_.empty() ? fail("nothing was received") : finish(std::move(reply_));
    } else if (reply_.size() > limits_.max_reply_size) {
      fail("the reply is too long");
    } else {
      start_timeout(limits_.idle_timeout, [](TextRequest & self) { self.finish(std::move(self.reply_)); });
      read();
    }
  }

  /// Replaces the previous timeout.
  void start_timeout(std::chrono::milliseconds time, void (*on_timeout)(TextRequest &))
  {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this(), on_timeout](const error_code & error) {
      if (!error) {
        on_timeout(*self);
      }
    });
  }

  void fail(const std::string & reason) { finish(tl::unexpected(reason)); }

  void finish(tl::expected<std::string, std::string> result)
  {
    if (!on_reply_) {
      return;
    }
    error_code ignored;
    timer_.cancel();
    resolver_.cancel();
    socket_.close(ignored);
    std::exchange(on_reply_, nullptr)(std::move(result));
  }

  tcp::resolver resolver_;
  tcp::socket socket_;
  asio::steady_timer timer_;
  std::string request_;
  TextReplyHandler on_reply_;
  TextRequestLimits limits_;
  std::array<char, 16384> buffer_;
  std::string reply_;
};

}  // namespace

void async_request_text(asio::io_context & io, const std::string & host, std::uint16_t port,
                        std::string_view request, TextReplyHandler on_reply, const TextRequestLimits & limits)
{
  std::make_shared<TextRequest>(io, request, std::move(on_reply), limits)->start(host, port);
}

}  // namespace ur_simulator
