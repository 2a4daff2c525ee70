#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace ur_simulator {

/// What a fetch may take, by the host's clock.
struct FetchLimits {
  std::chrono::milliseconds connect{5000};
  std::chrono::milliseconds first{5000};   ///< until the answer begins
  std::chrono::milliseconds silence{500};  ///< after which it is complete
  std::size_t size = 4 * 1024 * 1024;
};

/// Connects, sends the request and collects what comes until the peer closes or falls silent. `done` is
/// called exactly once, on the io_context's thread, never from inside of this call: the text, or why there is
/// none.
void fetch(boost::asio::io_context & io, const std::string & host, std::uint16_t port,
           std::string_view request, std::function<void(tl::expected<std::string, std::string>)> done,
           const FetchLimits & limits = {});

}  // namespace ur_simulator
