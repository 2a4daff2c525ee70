#include "services/service_clients.hpp"

#include <rcl/graph.h>
#include <rmw/rmw.h>

#include <algorithm>
#include <string_view>

#include "node/node_impl.hpp"
#include "rcl_support/rcl_compat.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
template <typename Bytes>
Gid to_gid(const Bytes & bytes) noexcept
{
  static_assert(sizeof(bytes) >= sizeof(Gid));
  Gid gid;
  std::copy_n(std::begin(bytes), gid.size(), gid.begin());
  return gid;
}

using ListEndpoints = decltype(&rcl_get_subscriptions_info_by_topic);

/// Appends the endpoints of a topic, which has the middleware's name.
bool list_endpoints(ListEndpoints list, NodeImpl & node, const std::string & topic, std::vector<Gid> & gids)
{
  rcutils_allocator_t allocator = rcutils_get_default_allocator();
  rcl_topic_endpoint_info_array_t endpoints = rcl_get_zero_initialized_topic_endpoint_info_array();
  if (list(node.handle(), &allocator, topic.c_str(), true, &endpoints) != RCL_RET_OK) {
    rcl_reset_error();
    return false;
  }
  for (std::size_t i = 0; i < endpoints.size; ++i) {
    gids.push_back(to_gid(endpoints.info_array[i].endpoint_gid));
  }
  ignore_rcl(rcl_topic_endpoint_info_array_fini(&endpoints, &allocator));
  return true;
}
}  // namespace

Gid client_of(const rmw_request_id_t & request) noexcept
{
  return to_gid(request.writer_guid);
}

bool same_participant(const Gid & one, const Gid & other) noexcept
{
  constexpr std::ptrdiff_t prefix = 12;
  return std::equal(one.begin(), one.begin() + prefix, other.begin());
}

std::optional<ServiceClients> find_clients(NodeImpl & node, const std::string & service)
{
  ServiceClients clients;
  // The names of the topics of a service in every DDS middleware.
  if (!list_endpoints(&rcl_get_subscriptions_info_by_topic, node, "rr" + service + "Reply",
                      clients.endpoints) ||
      !list_endpoints(&rcl_get_publishers_info_by_topic, node, "rq" + service + "Request",
                      clients.endpoints)) {
    return std::nullopt;
  }
  if (clients.endpoints.empty() &&
      compat::count_clients(node.handle(), service.c_str(), &clients.unlisted) != RCL_RET_OK) {
    rcl_reset_error();
    return std::nullopt;
  }
  return clients;
}

bool requests_carry_endpoints() noexcept
{
  return std::string_view(rmw_get_implementation_identifier()).starts_with("rmw_fastrtps");
}

ClientDiscovery discovery_of(const Gid & client, bool client_is_endpoint, const ServiceClients & known)
{
  const auto & endpoints = known.endpoints;
  if (!client_is_endpoint) {
    return endpoints.empty() && known.unlisted == 0 ? ClientDiscovery::gone : ClientDiscovery::found;
  }
  if (std::find(endpoints.begin(), endpoints.end(), client) != endpoints.end()) {
    return ClientDiscovery::found;
  }
  const bool exists = std::any_of(endpoints.begin(), endpoints.end(), [&client](const Gid & endpoint) {
    return same_participant(endpoint, client);
  });
  return exists ? ClientDiscovery::pending : ClientDiscovery::gone;
}

ClientDiscovery discovery_of(const rmw_request_id_t & request, NodeImpl & node, const std::string & service)
{
  const auto known = find_clients(node, service);
  return known ? discovery_of(client_of(request), requests_carry_endpoints(), *known)
               : ClientDiscovery::found;
}

}  // namespace rcl_cxx::detail
