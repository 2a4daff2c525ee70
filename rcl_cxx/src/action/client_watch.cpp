#include "action/client_watch.hpp"

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

bool contains(const std::vector<Gid> & gids, const Gid & gid)
{
  return std::find(gids.begin(), gids.end(), gid) != gids.end();
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

bool ClientWatch::is_lost(const ServiceClients & known, Clock::time_point now)
{
  if (contains(known.endpoints, client_)) {
    discovered_ = true;
    return false;
  }
  if (discovered_) {
    return true;
  }
  if (now < decides_from_) {
    endpoints_are_listed_ = endpoints_are_listed_ || !known.endpoints.empty();
    std::copy_if(known.endpoints.begin(), known.endpoints.end(), std::back_inserter(candidates_),
                 [this](const Gid & gid) { return !contains(candidates_, gid); });
    return false;
  }
  if (client_is_endpoint_) {
    return true;
  }
  std::erase_if(candidates_, [&known](const Gid & gid) { return !contains(known.endpoints, gid); });
  return candidates_.empty() && (endpoints_are_listed_ || known.unlisted == 0);
}

}  // namespace rcl_cxx::detail
