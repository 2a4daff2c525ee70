#include "robot_api/session.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <sstream>
#include <utility>

#include "robot_api/request_check.hpp"

namespace ur_simulator::robot_api {
namespace {

namespace http = boost::beast::http;

// Of a reply that is longer than the connection's buffer, one piece is sent per control cycle.
constexpr std::size_t piece_size = 32 * 1024;
// Received data that waits for its turn. TCP slows a client down that sends more.
constexpr std::size_t max_waiting = 64 * 1024;
// Time for a client to receive the reply to a request that was rejected while the client was sending it.
constexpr std::chrono::milliseconds rejection_time{1000};

std::string to_text(boost::beast::string_view text)
{
  return {text.data(), text.size()};
}

unsigned status_of(const boost::system::error_code & error)
{
  if (error == http::error::header_limit) {
    return 431;
  }
  return error == http::error::body_limit ? 413 : 400;
}

std::string encode(const Reply & reply, bool keep_alive, bool head)
{
  http::response<http::string_body> message(static_cast<http::status>(reply.status), 11);
  message.set(http::field::server, "UR simulator");
  if (!reply.body.empty()) {
    message.set(http::field::content_type, reply.content_type);
  }
  for (const auto & [name, value] : reply.headers) {
    message.set(name, value);
  }
  message.body() = reply.body;
  message.prepare_payload();
  message.keep_alive(keep_alive);
  if (head) {
    message.body().clear();  // the size in the header stays
  }
  std::ostringstream text;
  text << message;
  return text.str();
}

}  // namespace

struct Session::Parser {
  explicit Parser(const HttpLimits & limits)
  {
    parser.header_limit(static_cast<std::uint32_t>(limits.header_size));
    parser.body_limit(limits.body_size);
    parser.eager(true);
  }
  http::request_parser<http::string_body> parser;
  bool continue_sent = false;
};

Session::Session(std::shared_ptr<Connection> connection, Pendant & pendant, const HttpLimits & limits)
    : connection_(std::move(connection)),
      pendant_(pendant),
      limits_(limits),
      parser_(std::make_unique<Parser>(limits)),
      deadline_(Clock::now() + limits.request_time)
{
  connection_->allow_half_close();
}

Session::~Session() = default;

// ---- requests

void Session::receive(std::string_view bytes)
{
  if (rejected_) {
    return;
  }
  if (received_.empty() && !parser_->parser.got_some()) {
    extend_deadline();
  }
  received_.append(bytes);
  connection_->set_reading_paused(received_.size() > max_waiting);
}

bool Session::parse()
{
  auto & parser = parser_->parser;
  std::size_t used = 0;
  while (!parser.is_done() && used < received_.size()) {
    boost::system::error_code error;
    const std::size_t parsed =
        parser.put(boost::asio::buffer(received_.data() + used, received_.size() - used), error);
    used += parsed;
    if (error == http::error::need_more || (!error && parsed == 0)) {
      break;
    }
    if (error) {
      reject(status_of(error), error.message());
      return false;
    }
  }
  received_.erase(0, used);
  const bool waits = parser.is_header_done() && !parser.is_done() && !parser_->continue_sent &&
                     boost::beast::iequals(parser.get()[http::field::expect], "100-continue");
  if (waits) {
    parser_->continue_sent = true;
    connection_->send("HTTP/1.1 100 Continue\r\n\r\n");
  }
  return parser.is_done();
}

void Session::execute()
{
  http::request<http::string_body> message = parser_->parser.release();
  parser_ = std::make_unique<Parser>(limits_);
  keep_alive_ = message.keep_alive();
  head_ = message.method() == http::verb::head;
  const HttpRequest request{to_text(message.method_string()), to_text(message.target()),
                            to_text(message[http::field::content_type]), std::move(message.body())};
  connection_->log().from_peer("{} {} {}", request.method, request.target, request.body);
  Answer answer = execute_request(request, pendant_);
  if (Reply * reply = std::get_if<Reply>(&answer)) {
    pending_ = [reply = std::move(*reply)] { return std::optional(reply); };
  } else {
    pending_ = std::get<PendingReply>(std::move(answer));
  }
}

// ---- replies

void Session::reject(unsigned status, std::string_view message)
{
  rejected_ = true;
  keep_alive_ = false;
  received_.clear();
  connection_->log().to_peer("{} {}", status, message);
  connection_->send(encode(json_reply(status, {{"detail", message}}), false, false));
  deadline_ = Clock::now() + rejection_time;
}

void Session::send(const Reply & reply)
{
  connection_->log().to_peer("{} {}", reply.status, reply.body);
  outgoing_ = encode(reply, keep_alive_, head_);
  send_outgoing();
}

void Session::send_outgoing()
{
  const std::string_view piece = std::string_view(outgoing_).substr(0, piece_size);
  if (!connection_->send_or_drop(piece)) {
    return;  // earlier data is still waiting
  }
  outgoing_.erase(0, piece.size());
  extend_deadline();
  if (outgoing_.empty() && !keep_alive_) {
    connection_->close_after_sending("as the client requests");
  }
}

void Session::cycle()
{
  if (pending_) {
    if (const auto reply = pending_()) {
      pending_ = nullptr;
      send(*reply);
    }
  } else if (!outgoing_.empty()) {
    send_outgoing();
  }
  if (!replying() && keep_alive_ && parse()) {
    execute();
  }
  connection_->set_reading_paused(received_.size() > max_waiting);
  if (!replying() && connection_->end_of_input()) {
    connection_->close_after_sending("the client sends no more requests");
  } else if (pending_ == nullptr && Clock::now() > deadline_) {
    connection_->close(rejected_ ? "the request was rejected" : "there was no complete request in time");
  }
}

}  // namespace ur_simulator::robot_api
