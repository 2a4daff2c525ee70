#pragma once

#include <cstdint>

namespace ur_simulator {

constexpr bool bit_of(std::uint64_t bits, unsigned number)
{
  return ((bits >> number) & 1U) != 0;
}

/// Sets the bits that the mask selects. Bit 0 of mask and values is bit `shift` of `bits`.
inline void set_bits(std::uint64_t & bits, unsigned shift, std::uint64_t mask, std::uint64_t values)
{
  const std::uint64_t selected = mask << shift;
  bits = (bits & ~selected) | ((values << shift) & selected);
}

// A level of 0 to 1 is the fraction of the range of an analog IO: 4 to 20 mA or 0 to 10 V (script manual,
// "set_standard_analog_out"; UR, "RTDE Guide").

/// In A or V.
inline double analog_value(double level, bool voltage)
{
  return voltage ? 10.0 * level : 0.004 + 0.016 * level;
}
inline double analog_level(double value, bool voltage)
{
  return voltage ? value / 10.0 : (value - 0.004) / 0.016;
}

}  // namespace ur_simulator
