#pragma once

#include <cstdint>
#include <span>

#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::port_map {

using State = ControllerState;

/// What the values of the ports are read from.
struct PortSource {
  const State & state;
  const PolyscopeVersion & version;
};

/// Consecutive addresses with the same meaning; `i` counts from the first one. Value: uint16_t (registers) or
/// bool (bits).
template <typename Value>
struct PortRange {
  unsigned first;
  unsigned count;
  Value (*read)(const PortSource & source, unsigned i) = nullptr;   ///< null: reads as 0
  void (*write)(State & state, unsigned i, Value value) = nullptr;  ///< null: read-only
  bool (*accepts)(Value value) = nullptr;                           ///< null: all values
  MinVersion since = {};
};

using RegisterRange = PortRange<std::uint16_t>;
using BitRange = PortRange<bool>;

// Sorted by address.
std::span<const RegisterRange> register_ranges();
std::span<const BitRange> bit_ranges();

// Digital IO as words: bits 0 to 7 are those of the box, bits 8 and 9 those of the tool.

std::uint16_t standard_word(std::uint64_t digital_bits);
/// Sets the outputs that the mask selects; the other bits of the mask have no effect.
void write_standard_word(Io & io, std::uint64_t mask, std::uint64_t values);
std::uint16_t configurable_word(std::uint64_t digital_bits);
void write_configurable_word(Io & io, std::uint64_t mask, std::uint64_t values);

/// Registers and bits from 260 on: power, protective stop, emergency stop, freedrive, power button, and
/// whether the safety system stops the robot.
bool status_flag(const State & state, unsigned i);

}  // namespace ur_simulator::port_map
