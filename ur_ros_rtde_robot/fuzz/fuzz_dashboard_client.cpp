#include <ur_rtde/dashboard_client.h>

#include <array>
#include <iostream>

#include "connection/ports.hpp"
#include "input.hpp"
#include "memory_socket.hpp"

// The lines that a dashboard server sends to ur_rtde's DashboardClient.

namespace {

using ur_rtde::DashboardClient;

constexpr std::array<void (*)(DashboardClient & client), 7> queries{
    [](DashboardClient & client) { client.polyscopeVersion(); },
    [](DashboardClient & client) { client.isInRemoteControl(); },
    [](DashboardClient & client) { client.getSerialNumber(); },
    [](DashboardClient & client) { client.running(); },
    [](DashboardClient & client) { client.isProgramSaved(); },
    [](DashboardClient & client) { client.robotmode(); },
    [](DashboardClient & client) { client.play(); }};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static const auto * const no_output = std::cerr.rdbuf(nullptr);
  (void)no_output;
  ur_fuzz::Input input(data, size);
  const auto query = queries[input.take_option() % queries.size()];
  const std::size_t piece = input.take_option();
  ur_fuzz::set_replies(input.take_piece(0), piece);
  try {
    DashboardClient client(ur_fuzz::address, ur_ros_rtde::dashboard_port);
    client.connect();
    query(client);
  } catch (const std::exception &) {  // the error that the driver handles
  }
  return 0;
}
