#include "action/client_watch.hpp"

#include <algorithm>
#include <iterator>

namespace rcl_cxx::detail {
namespace {
bool contains(const std::vector<Gid> & gids, const Gid & gid)
{
  return std::find(gids.begin(), gids.end(), gid) != gids.end();
}
}  // namespace

bool ClientWatch::is_lost(const ServiceClients & known, Clock::time_point now)
{
  if (contains(known.endpoints, client_)) {
    discovered_ = true;
    return false;
  }
  if (discovered_) {
    return true;
  }
  if (client_is_endpoint_ && discovery_of(client_, true, known) == ClientDiscovery::gone) {
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
