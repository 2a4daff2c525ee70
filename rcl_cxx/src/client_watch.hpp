#pragma once

#include <rmw/types.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rcl_cxx::detail {
class NodeImpl;

/// The id of an endpoint, as the graph and the header of a request give it.
using Gid = std::array<std::uint8_t, 16>;

Gid client_of(const rmw_request_id_t & request) noexcept;

/// The clients of a service that are discovered.
struct ServiceClients {
  /// Writers of requests and readers of responses. Empty with a middleware that does not build services on
  /// topics (Zenoh).
  std::vector<Gid> endpoints{};
  /// Counted only when no endpoints are listed. At least 1 where that cannot be counted (Humble).
  std::size_t unlisted = 0;
};

/// Asks the middleware. Nothing if it does not answer.
std::optional<ServiceClients> find_clients(NodeImpl & node, const std::string & service);

/// Whether the id in a request's header is that of an endpoint of the client. It is with rmw_fastrtps.
/// rmw_cyclonedds puts an id of its own there.
bool requests_carry_endpoints() noexcept;

/// Decides whether the client that sent one request still exists. A client that is not discovered yet has
/// kDiscoveryLimit to be discovered.
class ClientWatch {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kDiscoveryLimit{1};

  ClientWatch(const Gid & client, bool client_is_endpoint, Clock::time_point now) noexcept
      : client_(client), client_is_endpoint_(client_is_endpoint), decides_from_(now + kDiscoveryLimit)
  {
  }

  bool is_lost(const ServiceClients & known, Clock::time_point now);

 private:
  const Gid client_;
  const bool client_is_endpoint_;
  const Clock::time_point decides_from_;
  bool discovered_ = false;
  /// Of a client that cannot be told from the others: the endpoints one of which is its own.
  std::vector<Gid> candidates_;
  bool endpoints_are_listed_ = false;
};

}  // namespace rcl_cxx::detail
