#include "primary/realtime_packet.hpp"

#include "common/big_endian.hpp"
#include "state/electrical_constants.hpp"

namespace ur_simulator::primary {
namespace {

std::size_t packet_size(const PolyscopeVersion & version)
{
  if (version >= PolyscopeVersion{5, 10, 0, 0}) {
    return 1220;
  }
  if (version >= (version.is_e_series() ? PolyscopeVersion{5, 4, 0, 0} : PolyscopeVersion{3, 10, 0, 0})) {
    return 1116;  // with the safety status
  }
  return version >= PolyscopeVersion{3, 5, 0, 0} ? 1108 : 1060;
}

}  // namespace

RealtimePacket::RealtimePacket(const PolyscopeVersion & version) : size_(packet_size(version))
{
  bytes_.reserve(2 * size_);
}

void RealtimePacket::put(double value)
{
  put_f64(bytes_, value);
}

template <typename Derived>
void RealtimePacket::put(const Eigen::MatrixBase<Derived> & values)
{
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    put(static_cast<double>(values[i]));
  }
}

void RealtimePacket::put_zeros(int count)
{
  for (int i = 0; i < count; ++i) {
    put(0.0);
  }
}

std::string_view RealtimePacket::encode(const ControllerState & state)
{
  bytes_.clear();
  put_u32(bytes_, static_cast<std::uint32_t>(size_));
  put_motion(state);
  put_status(state);
  // Later versions append fields: older versions send the beginning of the packet.
  bytes_.resize(size_, '\0');
  return bytes_;
}

void RealtimePacket::put_motion(const ControllerState & s)
{
  put(s.timestamp);
  put(s.target.position);
  put(s.target.velocity);
  put(s.target.acceleration);
  put(s.target.current);
  put(s.target.torque);
  put(s.measured.position);
  put(s.actual.velocity);
  put(s.measured.current);
  put(s.target.current);  // joint control currents
  put(s.measured.tcp_pose);
  put(s.actual_tcp_speed);
  put(s.reported_tcp_force);
  put(s.target_tcp_pose);
  put(s.target_tcp_speed);
  put(static_cast<double>(s.io.digital_inputs));
  put(s.joint_temperatures);
  put(s.actual_execution_time);
  put(0.0);  // test value
}

void RealtimePacket::put_status(const ControllerState & s)
{
  const bool powered = s.is_powered();
  put(static_cast<double>(s.robot_mode));
  for (const std::int32_t mode : s.joint_modes) {
    put(static_cast<double>(mode));
  }
  put(static_cast<double>(s.safety_mode));
  put_zeros(6);  // internal
  put(s.measured.tool_acceleration);
  put_zeros(6);  // internal
  put(s.reported_speed_scaling());
  put(s.payload.mass * s.actual_tcp_speed.head<3>().norm());  // linear momentum norm
  put_zeros(2);                                               // internal
  put(main_voltage);                                          // main voltage
  put(powered ? main_voltage : 0.0);                          // robot voltage
  put(powered ? idle_robot_current : 0.0);                    // robot current
  put(Vector6::Constant(powered ? main_voltage : 0.0));       // joint voltages
  put(static_cast<double>(s.io.digital_outputs));
  put(static_cast<double>(s.runtime_state));
  put(s.elbow_position);
  put(s.elbow_velocity);
  put(static_cast<double>(s.safety_mode));  // safety status
  put_zeros(3);                             // internal
  put(s.payload.mass);
  put(s.payload.center_of_gravity);
  put(s.payload.inertia);
}

}  // namespace ur_simulator::primary
