#include "connection/dashboard_request.hpp"
#include "connection/ports.hpp"
#include "connection/rtde/rtde_probe.hpp"
#include "input.hpp"
#include "memory_socket.hpp"

// The lines that a dashboard server sends to the driver's own requests. The target `dashboard_client` has
// those to ur_rtde.

namespace {

constexpr std::chrono::milliseconds timeout{2000};

void probe()
{
  auto socket = ur_ros_rtde::TcpSocket::connect(ur_fuzz::address, ur_ros_rtde::dashboard_port, timeout);
  if (socket) {
    (void)ur_ros_rtde::probe_dashboard(std::move(*socket), ur_fuzz::address, timeout);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  ur_fuzz::Input input(data, size);
  const bool probes = input.take_option() % 2 == 1;
  const std::size_t piece = input.take_option();
  ur_fuzz::set_replies(input.take_piece(0), piece);
  if (probes) {
    probe();
  } else {
    (void)ur_ros_rtde::dashboard_request(ur_fuzz::address, "running", timeout, {});
  }
  return 0;
}
