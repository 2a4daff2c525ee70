#include <ur_rtde/robot_state.h>
#include <ur_rtde/rtde.h>

#include <boost/system/error_code.hpp>
#include <iostream>

#include "connection/ports.hpp"
#include "connection/rtde/rtde_probe.hpp"
#include "input.hpp"
#include "memory_socket.hpp"

// The bytes that an RTDE server sends to ur_rtde, replies of the negotiation and data packages, and to the
// driver when it tests whether there is one.

namespace {

using namespace std::string_literals;

const std::vector<std::string> outputs{"timestamp",
                                       "actual_q",
                                       "robot_mode",
                                       "runtime_state",
                                       "payload_cog",
                                       "joint_mode",
                                       "safety_status_bits",
                                       "output_int_register_12",
                                       "output_double_register_12",
                                       "actual_digital_output_bits",
                                       "robot_status_bits"};

/// Replies to all requests before the first data package.
const std::string negotiation =
    "\x00\x04V\x01"s
    "\x00\x13v\x00\x00\x00\x05\x00\x00\x00\x19\x00\x00\x00\x01\x00\x00\x00\x00"s
    "\x00\x0bO\x01"
    "DOUBLE,"s
    "\x00\x04S\x01"s;

void receive_all()
{
  ur_rtde::RTDE rtde(ur_fuzz::address, ur_ros_rtde::rtde_port);
  rtde.connect();
  rtde.negotiateProtocolVersion();
  rtde.getControllerVersion();
  rtde.sendOutputSetup(outputs, 500.0);
  rtde.sendInputSetup({"speed_slider_mask", "speed_slider_fraction"});
  rtde.sendStart();
  auto state = std::make_shared<ur_rtde::RobotState>(outputs);
  while (!rtde.receiveData(state)) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static const auto * const no_output = std::cerr.rdbuf(nullptr);
  (void)no_output;
  ur_fuzz::Input input(data, size);
  const unsigned kind = input.take_option() % 4;
  const std::size_t piece = input.take_option();
  const bool negotiated = kind % 2 == 1;
  const std::string bytes = (negotiated ? negotiation : "") + std::string(input.take_piece(0));
  ur_fuzz::set_replies(bytes, piece);
  if (kind == 2) {
    (void)ur_ros_rtde::probe_rtde(ur_fuzz::address, std::chrono::seconds(2));
    return 0;
  }
  try {
    receive_all();
  } catch (const std::exception &) {  // the error that the driver handles
  }
  return 0;
}
