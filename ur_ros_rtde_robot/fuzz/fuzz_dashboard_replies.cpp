#include <ur_rtde/dashboard_client.h>

#include <iostream>

#include "connection/dashboard_request.hpp"
#include "connection/ports.hpp"
#include "input.hpp"
#include "reply_server.hpp"

// The lines that a dashboard server sends to the driver's own requests and to ur_rtde's DashboardClient.

namespace {

constexpr std::chrono::milliseconds limit{2000};

void query_all(const std::string & address)
{
  ur_rtde::DashboardClient client(address, ur_ros_rtde::dashboard_port);
  client.connect();
  client.polyscopeVersion();
  client.isInRemoteControl();
  client.getSerialNumber();
  client.running();
  client.isProgramSaved();
  client.robotmode();
  client.play();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static const std::string address = ur_fuzz::test_address();
  static ur_fuzz::ReplyServer server(address, ur_ros_rtde::dashboard_port);
  static const auto * const no_output = std::cerr.rdbuf(nullptr);
  (void)no_output;
  ur_fuzz::Input input(data, size);
  const bool client = input.take_option() % 2 == 1;
  server.set_reply(std::string(input.take_piece(0)));
  try {
    if (client) {
      query_all(address);
    } else {
      (void)ur_ros_rtde::dashboard_request(address, "running", limit, {});
    }
  } catch (const std::exception &) {  // the error that the driver handles
  }
  return 0;
}
