#pragma once

#include <chrono>
#include <vector>

#include "services/service_clients.hpp"

namespace rcl_cxx::detail {
/// Determines whether the client that sent a request still exists. A client counts as lost if no endpoint of
/// its process is known anymore, or if it has not been discovered within kDiscoveryLimit.
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
