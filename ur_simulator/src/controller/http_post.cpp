#include "controller/http_post.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <utility>

namespace ur_simulator {

namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds connect_timeout{5};
constexpr std::uint64_t max_response = 1U << 20U;  // bytes

/// The connection of a request. The pending asynchronous operations own it.
class HttpPost : public std::enable_shared_from_this<HttpPost> {
 public:
  HttpPost(boost::asio::io_context & io, const HttpAddress & to, std::string body, PeerLog log)
      : resolver_(io), stream_(io), log_(std::move(log)), request_(http::verb::post, to.path, 11)
  {
    request_.set(http::field::host, fmt::format("{}:{}", to.host, to.port));
    request_.set(http::field::user_agent, "ur_simulator");
    request_.set(http::field::content_type, "text/xml");
    request_.keep_alive(false);
    request_.body() = std::move(body);
    request_.prepare_payload();
    parser_.body_limit(max_response);
  }

  void start(const HttpAddress & to)
  {
    log_.to_peer("POST http://{}:{}{} {}", to.host, to.port, to.path, request_.body());
    resolver_.async_resolve(
        to.host, std::to_string(to.port),
        [self = shared_from_this()](const error_code & error, const tcp::resolver::results_type & endpoints) {
          error ? self->finish(error) : self->connect(endpoints);
        });
  }

  void cancel()
  {
    resolver_.cancel();
    stream_.close();
  }

  const auto & response() const { return response_; }

 private:
  void connect(const tcp::resolver::results_type & endpoints)
  {
    stream_.expires_after(connect_timeout);
    stream_.async_connect(endpoints,
                          [self = shared_from_this()](const error_code & error, const tcp::endpoint &) {
                            error ? self->finish(error) : self->send();
                          });
  }

  void send()
  {
    stream_.expires_never();
    http::async_write(stream_, request_, [self = shared_from_this()](const error_code & error, std::size_t) {
      error ? self->finish(error) : self->receive();
    });
  }

  void receive()
  {
    http::async_read(
        stream_, buffer_, parser_,
        [self = shared_from_this()](const error_code & error, std::size_t) { self->finish(error); });
  }

  void finish(const error_code & error)
  {
    stream_.close();
    if (error) {
      response_ = tl::unexpected(error.message());
    } else if (parser_.get().result() != http::status::ok) {
      response_ = tl::unexpected(fmt::format("HTTP status {}", parser_.get().result_int()));
    } else {
      response_ = std::move(parser_.get().body());
    }
    if (*response_) {
      log_.from_peer("{}", **response_);
    } else {
      log_.note("no response: {}", response_->error());
    }
  }

  tcp::resolver resolver_;
  beast::tcp_stream stream_;
  PeerLog log_;
  beast::flat_buffer buffer_;
  http::request<http::string_body> request_;
  http::response_parser<http::string_body> parser_;
  std::optional<tl::expected<std::string, std::string>> response_;
};

/// Cancels the connection with the last reference.
class HttpPostHandle final : public HttpRequest {
 public:
  explicit HttpPostHandle(std::shared_ptr<HttpPost> post) : post_(std::move(post)) {}
  ~HttpPostHandle() override { post_->cancel(); }
  HttpPostHandle(const HttpPostHandle &) = delete;
  HttpPostHandle & operator=(const HttpPostHandle &) = delete;
  const std::optional<tl::expected<std::string, std::string>> & response() const override
  {
    return post_->response();
  }

 private:
  std::shared_ptr<HttpPost> post_;
};

}  // namespace

std::shared_ptr<HttpRequest> post_xml(boost::asio::io_context & io, const HttpAddress & to, std::string body,
                                      PeerLog log)
{
  const auto post = std::make_shared<HttpPost>(io, to, std::move(body), std::move(log));
  post->start(to);
  return std::make_shared<HttpPostHandle>(post);
}

}  // namespace ur_simulator
