#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "port_map/port_range.hpp"
#include "state/electrical_constants.hpp"
#include "state/io_values.hpp"

namespace ur_simulator::port_map {
namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr std::uint16_t tool_mode_running = 253;
constexpr MinVersion revolutions_since{MinVersion::always, {3, 1, 0, 0}};

/// Two's complement, limited to the range of the register.
std::uint16_t to_word(double value)
{
  using Limits = std::numeric_limits<std::int16_t>;
  const double limited = std::clamp<double>(value, Limits::min(), Limits::max());
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(limited)));
}

template <typename Derived>
double element(const Eigen::MatrixBase<Derived> & values, unsigned i)
{
  return static_cast<double>(values[static_cast<Eigen::Index>(i)]);
}

/// Element of a pose, its offset or speed: the translation with `per_meter` units per m, the rotation in
/// mrad.
std::uint16_t pose_word(const Vector6 & pose, unsigned i, double per_meter)
{
  return to_word(element(pose, i) * (i < 3 ? per_meter : 1000.0));
}

double revolutions(const State & state, unsigned i)
{
  return std::floor(element(state.actual.position, i) / full_turn);
}

double joint_angle(const State & state, unsigned i)
{
  return element(state.actual.position, i) - full_turn * revolutions(state, i);
}

std::uint16_t version_word(const PolyscopeVersion & version, unsigned i)
{
  return static_cast<std::uint16_t>(i == 0 ? version.major : version.minor);
}

/// Milliseconds, seconds, minutes, hours and days of the stored time.
std::uint16_t split_time_word(const State & state, unsigned i)
{
  constexpr std::array<std::uint64_t, 5> units{1, 1000, 60'000, 3'600'000, 86'400'000};  // ms
  const auto time = static_cast<std::uint64_t>(state.ports.split_time * 1000.0);
  return static_cast<std::uint16_t>((i + 1 < units.size() ? time % units[i + 1] : time) / units[i]);
}

/// The function that reads a register with a C++ expression; `i` is the index in its range, `s` the state,
/// `version` that of PolyScope.
#define UR_READ(expression)                                                     \
  []([[maybe_unused]] const PortSource & source, [[maybe_unused]] unsigned i) { \
    [[maybe_unused]] const auto & [s, version] = source;                        \
    return static_cast<std::uint16_t>(expression);                              \
  }
/// The function that writes `value` with a C++ statement.
#define UR_WRITE(statement)                                                                           \
  []([[maybe_unused]] State & s, [[maybe_unused]] unsigned i, [[maybe_unused]] std::uint16_t value) { \
    statement;                                                                                        \
  }

/// As a fraction of the range, 0 to 65535. `bit` of the types selects voltage.
template <std::array<double, 2> Io::* values, std::uint32_t Io::* types, unsigned bit>
constexpr RegisterRange analog_value_at(unsigned address)
{
  return {
      address, 1,
      UR_READ(std::lround(
          65535.0 * std::clamp(analog_level((s.io.*values)[bit % 2], bit_of(s.io.*types, bit)), 0.0, 1.0)))};
}

/// 0: current, 1: voltage.
template <std::uint32_t Io::* types, unsigned bit>
constexpr RegisterRange analog_domain_at(unsigned address)
{
  return {address, 1, UR_READ(bit_of(s.io.*types, bit)),
          UR_WRITE(s.io.*types = (s.io.*types & ~(1U << bit)) | std::uint32_t{value} << bit),
          [](std::uint16_t domain) { return domain <= 1; }};
}

template <unsigned n>
constexpr RegisterRange analog_output_at(unsigned address)
{
  constexpr unsigned bit = 2 + n;
  RegisterRange range = analog_value_at<&Io::analog_outputs, &Io::analog_io_types, bit>(address);
  range.write =
      UR_WRITE(s.io.analog_outputs[n] = analog_value(value / 65535.0, bit_of(s.io.analog_io_types, bit)));
  return range;
}

constexpr bool is_tool_voltage(std::uint16_t value)
{
  return value == 0 || value == 12 || value == 24;
}

constexpr std::array register_table{
    RegisterRange{0, 1, UR_READ(standard_word(s.io.digital_inputs))},
    RegisterRange{1, 1, UR_READ(standard_word(s.io.digital_outputs)),
                  UR_WRITE(write_standard_word(s.io, 0xffff, value))},
    // Masks: each 1 sets (2) or clears (3) an output.
    RegisterRange{2, 1, nullptr, UR_WRITE(write_standard_word(s.io, value, value))},
    RegisterRange{3, 1, nullptr, UR_WRITE(write_standard_word(s.io, value, 0))},
    analog_value_at<&Io::analog_inputs, &Io::analog_io_types, 0>(4),
    analog_domain_at<&Io::analog_io_types, 0>(5),
    analog_value_at<&Io::analog_inputs, &Io::analog_io_types, 1>(6),
    analog_domain_at<&Io::analog_io_types, 1>(7),
    analog_value_at<&Io::tool_analog_inputs, &Io::tool_analog_input_types, 0>(8),
    analog_domain_at<&Io::tool_analog_input_types, 0>(9),
    analog_value_at<&Io::tool_analog_inputs, &Io::tool_analog_input_types, 1>(10),
    analog_domain_at<&Io::tool_analog_input_types, 1>(11),
    analog_output_at<0>(16),
    analog_domain_at<&Io::analog_io_types, 2>(17),
    analog_output_at<1>(18),
    analog_domain_at<&Io::analog_io_types, 3>(19),
    RegisterRange{20, 1, UR_READ(s.io.tool_output_voltage), UR_WRITE(s.io.tool_output_voltage = value),
                  is_tool_voltage},
    RegisterRange{21, 1, UR_READ(s.io.digital_inputs >> 16 & 0x3)},
    RegisterRange{22, 1, UR_READ(s.io.digital_outputs >> 16 & 0x3),
                  UR_WRITE(set_bits(s.io.digital_outputs, 16, 0x3, value))},
    // 24 to 29: Euromap67, which is not installed.
    RegisterRange{30, 1, UR_READ(configurable_word(s.io.digital_inputs))},
    RegisterRange{31, 1, UR_READ(configurable_word(s.io.digital_outputs)),
                  UR_WRITE(write_configurable_word(s.io, 0xff, value))},
    RegisterRange{32, 1, nullptr, UR_WRITE(write_configurable_word(s.io, value, value))},
    RegisterRange{33, 1, nullptr, UR_WRITE(write_configurable_word(s.io, value, 0))},
    RegisterRange{128, 128, UR_READ(s.ports.general_purpose[i]),
                  UR_WRITE(s.ports.general_purpose[i] = value)},
    RegisterRange{256, 2, UR_READ(version_word(version, i))},
    RegisterRange{258, 1, UR_READ(s.robot_mode)},
    RegisterRange{260, 6, UR_READ(status_flag(s, i))},
    RegisterRange{266, 1, UR_READ(s.safety_mode)},
    RegisterRange{270, 6, UR_READ(to_word(1000.0 * joint_angle(s, i)))},
    RegisterRange{280, 6, UR_READ(to_word(1000.0 * element(s.actual.velocity, i)))},
    RegisterRange{290, 6, UR_READ(to_word(1000.0 * element(s.actual.current, i)))},
    RegisterRange{300, 6, UR_READ(to_word(element(s.joint_temperatures, i)))},
    RegisterRange{310, 6, UR_READ(s.joint_modes[i])},
    RegisterRange{320, 6, UR_READ(to_word(revolutions(s, i))), nullptr, nullptr, revolutions_since},
    RegisterRange{400, 6, UR_READ(pose_word(s.actual_tcp_pose, i, 1e4))},
    RegisterRange{410, 6, UR_READ(pose_word(s.actual_tcp_speed, i, 1e3))},
    RegisterRange{420, 6, UR_READ(pose_word(s.tcp_offset, i, 1e3))},
    RegisterRange{450, 1, UR_READ(s.is_powered() ? to_word(1000.0 * idle_robot_current) : 0)},
    // 451: current of the inputs and outputs, which is not modelled.
    RegisterRange{768, 1, UR_READ(tool_mode_running)},
    RegisterRange{769, 1, UR_READ(to_word(s.io.tool_temperature))},
    RegisterRange{770, 1, UR_READ(to_word(1000.0 * s.io.tool_output_current))},
    // Writing stores the time, which the next registers return.
    RegisterRange{2048, 1, nullptr, UR_WRITE(s.ports.split_time = s.timestamp)},
    RegisterRange{2049, 5, UR_READ(split_time_word(s, i))},
};

#undef UR_READ
#undef UR_WRITE

}  // namespace

std::span<const RegisterRange> register_ranges()
{
  return register_table;
}

}  // namespace ur_simulator::port_map
