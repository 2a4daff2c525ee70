#pragma once

#include <rmw/types.h>

#include <array>
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

/// Returns whether both endpoints belong to the same participant (a process, or a context of it). Only for
/// ids of DDS, whose first 12 bytes identify the participant.
bool same_participant(const Gid & one, const Gid & other) noexcept;

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

/// What discovery knows about the client that waits for a response.
enum class ClientDiscovery {
  gone,     ///< No endpoint of its process is known anymore: it has ended, or its lease has.
  pending,  ///< It exists, but the endpoint that receives the response has not been discovered yet.
  found     ///< The response can be sent, as far as is known.
};

/// `client` is the id in the request. A request is received only after one endpoint of its client was
/// discovered. Hence a client without a known endpoint is not new, but gone.
ClientDiscovery discovery_of(const Gid & client, bool client_is_endpoint, const ServiceClients & known);

/// The same for the sender of a request to the service.
ClientDiscovery discovery_of(const rmw_request_id_t & request, NodeImpl & node, const std::string & service);

}  // namespace rcl_cxx::detail
