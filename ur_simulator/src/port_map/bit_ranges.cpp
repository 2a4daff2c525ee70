#include <array>

#include "port_map/port_range.hpp"
#include "state/io_values.hpp"

namespace ur_simulator::port_map {
namespace {

/// RTDE has all 128 boolean registers from these versions on.
constexpr MinVersion boolean_registers_since{{5, 3, 0, 0}, {3, 9, 0, 0}};

constexpr std::uint64_t mask_of(unsigned i, bool value = true)
{
  return std::uint64_t{value} << i;
}

/// The function that reads bit `i` of a range with a C++ expression; `s` is the state.
#define UR_READ(expression)                   \
  [](const PortSource & source, unsigned i) { \
    const State & s = source.state;           \
    return expression;                        \
  }
/// The function that writes `value` with a C++ statement.
#define UR_WRITE(statement) [](State & s, unsigned i, bool value) { statement; }

constexpr std::array bit_table{
    BitRange{0, 16, UR_READ(bit_of(standard_word(s.io.digital_inputs), i))},
    BitRange{16, 16, UR_READ(bit_of(standard_word(s.io.digital_outputs), i)),
             UR_WRITE(write_standard_word(s.io, mask_of(i), mask_of(i, value)))},
    // Masks: True sets (32) or clears (48) the output, False has no effect.
    BitRange{32, 16, nullptr, UR_WRITE(write_standard_word(s.io, mask_of(i, value), mask_of(i)))},
    BitRange{48, 16, nullptr, UR_WRITE(write_standard_word(s.io, mask_of(i, value), 0))},
    // 64 to 127: Euromap67, which is not installed.
    BitRange{128, 8, UR_READ(bit_of(configurable_word(s.io.digital_inputs), i))},
    BitRange{136, 8, UR_READ(bit_of(configurable_word(s.io.digital_outputs), i)),
             UR_WRITE(write_configurable_word(s.io, mask_of(i), mask_of(i, value)))},
    BitRange{144, 8, nullptr, UR_WRITE(write_configurable_word(s.io, mask_of(i, value), mask_of(i)))},
    BitRange{152, 8, nullptr, UR_WRITE(write_configurable_word(s.io, mask_of(i, value), 0))},
    BitRange{260, 6, UR_READ(status_flag(s, i))},
    BitRange{300, 128, UR_READ(s.inputs.bits.test(i)), UR_WRITE(s.inputs.bits.set(i, value)), nullptr,
             boolean_registers_since},
    BitRange{500, 128, UR_READ(s.outputs.bits.test(i)), nullptr, nullptr, boolean_registers_since},
};

#undef UR_READ
#undef UR_WRITE

}  // namespace

std::span<const BitRange> bit_ranges()
{
  return bit_table;
}

std::uint16_t standard_word(std::uint64_t digital_bits)
{
  return static_cast<std::uint16_t>((digital_bits & 0xff) | ((digital_bits >> 16) & 0x3) << 8);
}

void write_standard_word(Io & io, std::uint64_t mask, std::uint64_t values)
{
  set_bits(io.digital_outputs, 0, mask & 0xff, values);
  set_bits(io.digital_outputs, 16, (mask >> 8) & 0x3, values >> 8);
}

std::uint16_t configurable_word(std::uint64_t digital_bits)
{
  return static_cast<std::uint16_t>((digital_bits >> 8) & 0xff);
}

void write_configurable_word(Io & io, std::uint64_t mask, std::uint64_t values)
{
  set_bits(io.digital_outputs, 8, mask & 0xff, values);
}

bool status_flag(const ControllerState & state, unsigned i)
{
  constexpr unsigned power_button_bit = 3;  // of robot_status_bits (UR, "RTDE Guide")
  constexpr unsigned safety_stop_bit = 10;  // of safety_status_bits
  switch (i) {
    case 0:
      return state.is_powered();
    case 1:
      return state.safety_mode == SafetyMode::protective_stop;
    case 2:
      return state.safety_mode == SafetyMode::robot_emergency_stop ||
             state.safety_mode == SafetyMode::system_emergency_stop;
    case 3:
      return state.freedrive;
    case 4:
      return bit_of(state.robot_status_bits, power_button_bit);
    default:
      return bit_of(state.safety_status_bits, safety_stop_bit);
  }
}

}  // namespace ur_simulator::port_map
