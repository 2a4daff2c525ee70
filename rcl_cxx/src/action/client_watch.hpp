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

/// The id of an endpoint, as in the graph and in the header of a request.
using Gid = std::array<std::uint8_t, 16>;

Gid client_of(const rmw_request_id_t & request) noexcept;

/// The discovered clients of a service.
struct ServiceClients {
  /// Writers of requests and readers of responses. Empty if the middleware does not build services on topics
  /// (Zenoh).
  std::vector<Gid> endpoints{};
  /// The number of clients if no endpoints are listed. 1 if clients cannot be counted (Humble).
  std::size_t unlisted = 0;
};

/// Returns nothing if the middleware cannot list clients.
std::optional<ServiceClients> find_clients(NodeImpl & node, const std::string & service);

/// Returns whether the header of a request contains the id of an endpoint of the client, as with
/// rmw_fastrtps. rmw_cyclonedds uses a different id.
bool requests_carry_endpoints() noexcept;

/// Determines whether the client that sent a request still exists. A client counts as lost if it has not been
/// discovered within kDiscoveryLimit.
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
  /// If the request does not contain an endpoint: the endpoints one of which may be the client's.
  std::vector<Gid> candidates_;
  bool endpoints_are_listed_ = false;
};

}  // namespace rcl_cxx::detail
