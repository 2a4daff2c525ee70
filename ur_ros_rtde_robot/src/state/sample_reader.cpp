#include "state/sample_reader.hpp"

#include <ur_rtde/robot_state.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {

using ur_rtde::rtde_type_variant_;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Values of the fields that the controller does not provide.
Sample empty_sample()
{
  Sample sample{};
  for (auto * field : {&sample.target_q,
                       &sample.target_qd,
                       &sample.target_qdd,
                       &sample.target_current,
                       &sample.target_moment,
                       &sample.actual_q,
                       &sample.actual_qd,
                       &sample.actual_current,
                       &sample.actual_current_as_torque,
                       &sample.joint_control_output,
                       &sample.joint_temperatures,
                       &sample.actual_joint_voltage,
                       &sample.actual_tcp_pose,
                       &sample.actual_tcp_speed,
                       &sample.target_tcp_pose,
                       &sample.target_tcp_speed,
                       &sample.tcp_offset,
                       &sample.actual_tcp_force,
                       &sample.ft_raw_wrench,
                       &sample.payload_inertia}) {
    field->fill(nan);
  }
  sample.actual_tool_accelerometer.fill(nan);
  sample.payload_cog.fill(nan);
  sample.analog_inputs.fill(nan);
  sample.analog_outputs.fill(nan);
  for (double Sample::* field :
       {&Sample::actual_execution_time, &Sample::actual_momentum, &Sample::actual_main_voltage,
        &Sample::actual_robot_voltage, &Sample::actual_robot_current, &Sample::payload}) {
    sample.*field = nan;
  }
  return sample;
}

/// Creates one copy function per variable. Skips variables that the state lacks; values of another type are
/// not copied.
class Binder {
 public:
  Binder(const ur_rtde::RobotState & state, std::vector<std::function<void(Sample &)>> & copies)
      : state_(state), copies_(copies)
  {
  }

  template <class T, std::size_t N>
  void vector(const char * name, std::array<T, N> Sample::* field)
  {
    if (const auto * entry = state_.getEntry(name)) {
      copies_.push_back([entry, field](Sample & sample) {
        const auto * value = boost::get<std::vector<T>>(entry);
        if (value != nullptr && value->size() == N) {
          std::copy(value->begin(), value->end(), (sample.*field).begin());
        }
      });
    }
  }

  template <class Source, class Target>
  void scalar(const std::string & name, Target && target)
  {
    if (const auto * entry = state_.getEntry(name)) {
      copies_.push_back([entry, target = std::forward<Target>(target)](Sample & sample) {
        if (const auto * value = boost::get<Source>(entry)) {
          target(sample, *value);
        }
      });
    }
  }

  void number(const char * name, double Sample::* field)
  {
    scalar<double>(name, [field](Sample & sample, double value) { sample.*field = value; });
  }

 private:
  const ur_rtde::RobotState & state_;
  std::vector<std::function<void(Sample &)>> & copies_;
};

void bind_joints(Binder & bind)
{
  bind.vector("target_q", &Sample::target_q);
  bind.vector("target_qd", &Sample::target_qd);
  bind.vector("target_qdd", &Sample::target_qdd);
  bind.vector("target_current", &Sample::target_current);
  bind.vector("target_moment", &Sample::target_moment);
  bind.vector("actual_q", &Sample::actual_q);
  bind.vector("actual_qd", &Sample::actual_qd);
  bind.vector("actual_current", &Sample::actual_current);
  bind.vector("actual_current_as_torque", &Sample::actual_current_as_torque);
  bind.vector("joint_control_output", &Sample::joint_control_output);
  bind.vector("joint_temperatures", &Sample::joint_temperatures);
  bind.vector("actual_joint_voltage", &Sample::actual_joint_voltage);
  bind.vector("joint_mode", &Sample::joint_mode);
}

void bind_tool(Binder & bind)
{
  bind.vector("actual_TCP_pose", &Sample::actual_tcp_pose);
  bind.vector("actual_TCP_speed", &Sample::actual_tcp_speed);
  bind.vector("actual_TCP_force", &Sample::actual_tcp_force);
  bind.vector("tcp_offset", &Sample::tcp_offset);
  bind.vector("target_TCP_pose", &Sample::target_tcp_pose);
  bind.vector("target_TCP_speed", &Sample::target_tcp_speed);
  bind.vector("ft_raw_wrench", &Sample::ft_raw_wrench);
  bind.vector("actual_tool_accelerometer", &Sample::actual_tool_accelerometer);
  bind.number("payload", &Sample::payload);
  bind.vector("payload_cog", &Sample::payload_cog);
  bind.vector("payload_inertia", &Sample::payload_inertia);
}

void bind_controller(Binder & bind)
{
  bind.number("timestamp", &Sample::controller_time);
  bind.number("speed_scaling", &Sample::speed_scaling);
  bind.number("target_speed_fraction", &Sample::target_speed_fraction);
  bind.number("actual_execution_time", &Sample::actual_execution_time);
  bind.number("actual_momentum", &Sample::actual_momentum);
  bind.number("actual_main_voltage", &Sample::actual_main_voltage);
  bind.number("actual_robot_voltage", &Sample::actual_robot_voltage);
  bind.number("actual_robot_current", &Sample::actual_robot_current);
  bind.scalar<std::int32_t>("robot_mode",
                            [](Sample & s, std::int32_t value) { s.robot_mode = RobotMode{value}; });
  bind.scalar<std::int32_t>("safety_mode",
                            [](Sample & s, std::int32_t value) { s.safety_mode = SafetyMode{value}; });
  bind.scalar<std::uint32_t>("runtime_state",
                             [](Sample & s, std::uint32_t value) { s.runtime_state = RuntimeState{value}; });
  bind.scalar<std::uint32_t>("robot_status_bits",
                             [](Sample & s, std::uint32_t value) { s.robot_status_bits = value; });
  bind.scalar<std::uint32_t>("safety_status_bits",
                             [](Sample & s, std::uint32_t value) { s.safety_status_bits = value; });
}

void bind_io(Binder & bind)
{
  bind.scalar<std::uint64_t>("actual_digital_input_bits",
                             [](Sample & s, std::uint64_t value) { s.digital_inputs = value; });
  bind.scalar<std::uint64_t>("actual_digital_output_bits",
                             [](Sample & s, std::uint64_t value) { s.digital_outputs = value; });
  for (std::size_t i = 0; i < 2; ++i) {
    bind.scalar<double>("standard_analog_input" + std::to_string(i),
                        [i](Sample & s, double value) { s.analog_inputs[i] = value; });
    bind.scalar<double>("standard_analog_output" + std::to_string(i),
                        [i](Sample & s, double value) { s.analog_outputs[i] = value; });
  }
}

void bind_registers(Binder & bind, int offset)
{
  bind.scalar<std::int32_t>(
      "output_int_register_" + std::to_string(2 + offset),
      [](Sample & s, std::int32_t value) { s.async.word = static_cast<std::uint32_t>(value); });
  for (std::size_t i = 0; i < 8; ++i) {
    const auto number = std::to_string(Sample::first_output_register + static_cast<int>(i) + offset);
    bind.scalar<std::int32_t>("output_int_register_" + number,
                              [i](Sample & s, std::int32_t value) { s.output_int_registers[i] = value; });
    bind.scalar<double>("output_double_register_" + number,
                        [i](Sample & s, double value) { s.output_double_registers[i] = value; });
  }
}

}  // namespace

SampleReader::SampleReader(std::shared_ptr<ur_rtde::RobotState> state, int register_offset,
                           bool force_is_at_flange)
    : state_(std::move(state)), force_is_at_flange_(force_is_at_flange)
{
  Binder bind(*state_, copies_);
  bind_joints(bind);
  bind_tool(bind);
  bind_controller(bind);
  bind_io(bind);
  bind_registers(bind, register_offset);
}

SampleReader::~SampleReader() = default;

std::chrono::steady_clock::time_point SampleReader::read(Sample & sample) const
{
  const auto sequence = sample.sequence;
  const auto link = sample.link;
  sample = empty_sample();
  sample.sequence = sequence;
  sample.link = link;

  state_->lockUpdateStateMutex();
  const std::unique_ptr<ur_rtde::RobotState, void (*)(ur_rtde::RobotState *)> unlock(
      state_.get(), [](ur_rtde::RobotState * state) { state->unlockUpdateStateMutex(); });
  for (const auto & copy : copies_) {
    copy(sample);
  }
  if (force_is_at_flange_ && std::isfinite(sample.tcp_offset[0])) {
    sample.actual_tcp_force = at_tcp(sample.actual_tcp_force, sample.actual_tcp_pose, sample.tcp_offset);
  }
  return state_->getPackageTime();
}

}  // namespace ur_ros_rtde
