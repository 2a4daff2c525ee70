#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace ur_simulator {

/// Limits of a text request. Times are measured with the host's clock.
struct TextRequestLimits {
  std::chrono::milliseconds connect_timeout{5000};
  std::chrono::milliseconds reply_timeout{5000};  ///< from the request to the first byte of the reply
  std::chrono::milliseconds idle_timeout{500};    ///< silence that ends the reply
  std::size_t max_reply_size = 4 * 1024 * 1024;   ///< bytes
};

/// The complete reply, or the reason why there is none.
using TextReplyHandler = std::function<void(tl::expected<std::string, std::string>)>;

/// Connects to the host, sends the request and collects the reply until the peer closes the connection or
/// sends nothing for the idle timeout. `on_reply` is called exactly once, on the thread of the io_context and
/// never before this function returns.
void async_request_text(boost::asio::io_context & io, const std::string & host, std::uint16_t port,
                        std::string_view request, TextReplyHandler on_reply,
                        const TextRequestLimits & limits = {});

}  // namespace ur_simulator
