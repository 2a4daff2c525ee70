#include "net/fetch.hpp"

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

/// One fetch; keeps itself alive by the handlers that wait.
class Fetch : public std::enable_shared_from_this<Fetch> {
 public:
  using Done = std::function<void(tl::expected<std::string, std::string>)>;

  Fetch(asio::io_context & io, std::string_view request, Done done, const FetchLimits & limits)
      : resolver_(io), socket_(io), timer_(io), request_(request), done_(std::move(done)), limits_(limits)
  {
  }

  void start(const std::string & host, std::uint16_t port)
  {
    limit(limits_.connect, [](Fetch & self) { self.fail("connect timed out"); });
    resolver_.async_resolve(
        host, std::to_string(port),
        [self = shared_from_this()](const error_code & error, const tcp::resolver::results_type & found) {
          if (error) {
            self->fail(error.message());
          } else if (self->done_) {
            self->connect(found);
          }
        });
  }

 private:
  void connect(const tcp::resolver::results_type & found)
  {
    asio::async_connect(socket_, found,
                        [self = shared_from_this()](const error_code & error, const tcp::endpoint &) {
                          error ? self->fail(error.message()) : self->ask();
                        });
  }

  void ask()
  {
    if (!done_) {
      return;
    }
    limit(limits_.first, [](Fetch & self) { self.fail("nothing was received"); });
    asio::async_write(socket_, asio::buffer(request_),
                      [self = shared_from_this()](const error_code & error, std::size_t) {
                        error ? self->fail(error.message()) : self->read();
                      });
  }

  void read()
  {
    if (!done_) {
      return;
    }
    socket_.async_read_some(
        asio::buffer(buffer_),
        [self = shared_from_this()](const error_code & error, std::size_t size) { self->take(error, size); });
  }

  void take(const error_code & error, std::size_t size)
  {
    text_.append(buffer_.data(), size);
    if (error) {
      text_.empty() ? fail("nothing was received") : finish(std::move(text_));
    } else if (text_.size() > limits_.size) {
      fail("the answer is too long");
    } else {
      limit(limits_.silence, [](Fetch & self) { self.finish(std::move(self.text_)); });
      read();
    }
  }

  /// In place of the limit before.
  void limit(std::chrono::milliseconds time, void (*then)(Fetch &))
  {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this(), then](const error_code & error) {
      if (!error) {
        then(*self);
      }
    });
  }

  void fail(const std::string & why) { finish(tl::unexpected(why)); }

  void finish(tl::expected<std::string, std::string> result)
  {
    if (!done_) {
      return;
    }
    error_code ignored;
    timer_.cancel();
    resolver_.cancel();
    socket_.close(ignored);
    std::exchange(done_, nullptr)(std::move(result));
  }

  tcp::resolver resolver_;
  tcp::socket socket_;
  asio::steady_timer timer_;
  std::string request_;
  Done done_;
  FetchLimits limits_;
  std::array<char, 16384> buffer_;
  std::string text_;
};

}  // namespace

void fetch(asio::io_context & io, const std::string & host, std::uint16_t port, std::string_view request,
           std::function<void(tl::expected<std::string, std::string>)> done, const FetchLimits & limits)
{
  std::make_shared<Fetch>(io, request, std::move(done), limits)->start(host, port);
}

}  // namespace ur_simulator
