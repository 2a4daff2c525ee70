#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rtde/fields.hpp"

namespace ur_simulator::rtde {
namespace {

using State = ControllerState;

constexpr Since upper_range{{5, 3, 0, 0}, {3, 9, 0, 0}};

#define UR_INPUT(statement)                                                                   \
  []([[maybe_unused]] Reader & from, [[maybe_unused]] unsigned i, [[maybe_unused]] State & s, \
     [[maybe_unused]] MaskedInputs & m) { statement; }

void add_registers(std::vector<InputField> & fields)
{
  using enum FieldType;
  const auto read_word = UR_INPUT(const std::uint32_t word = from.u32(); for (unsigned b = 0; b < 32; ++b) {
    s.inputs.bits.set(32 * i + b, ((word >> b) & 1u) != 0);
  });
  fields.push_back({"input_bit_registers0_to_31", uint32, {}, 0, read_word});
  fields.push_back({"input_bit_registers32_to_63", uint32, {}, 1, read_word});
  for (unsigned n = 64; n < 128; ++n) {
    fields.push_back({fmt::format("input_bit_register_{}", n), boolean, upper_range, n,
                      UR_INPUT(s.inputs.bits.set(i, from.u8() != 0))});
  }
  for (unsigned n = 0; n < 48; ++n) {
    const Since since = n < 24 ? Since{} : upper_range;
    fields.push_back({fmt::format("input_int_register_{}", n), int32, since, n,
                      UR_INPUT(s.inputs.integers[i] = from.i32())});
    fields.push_back({fmt::format("input_double_register_{}", n), double_, since, n,
                      UR_INPUT(s.inputs.doubles[i] = from.f64())});
  }
}

void add_masked(std::vector<InputField> & fields)
{
  using enum FieldType;
  using M = MaskedInputs;
  const std::vector<InputField> rows{
      {"speed_slider_mask",
       uint32,
       {},
       0,
       UR_INPUT(m.speed_slider_mask = from.u32(); m.touched |= M::speed_slider)},
      {"speed_slider_fraction",
       double_,
       {},
       0,
       UR_INPUT(m.speed_slider_fraction = from.f64(); m.touched |= M::speed_slider)},
      {"standard_digital_output_mask",
       uint8,
       {},
       0,
       UR_INPUT(m.standard_digital_mask = from.u8(); m.touched |= M::standard_digital)},
      {"standard_digital_output",
       uint8,
       {},
       0,
       UR_INPUT(m.standard_digital_values = from.u8(); m.touched |= M::standard_digital)},
      {"configurable_digital_output_mask",
       uint8,
       {},
       0,
       UR_INPUT(m.configurable_digital_mask = from.u8(); m.touched |= M::configurable_digital)},
      {"configurable_digital_output",
       uint8,
       {},
       0,
       UR_INPUT(m.configurable_digital_values = from.u8(); m.touched |= M::configurable_digital)},
      {"tool_digital_output_mask",
       uint8,
       {},
       0,
       UR_INPUT(m.tool_digital_mask = from.u8(); m.touched |= M::tool_digital)},
      {"tool_digital_output",
       uint8,
       {},
       0,
       UR_INPUT(m.tool_digital_values = from.u8(); m.touched |= M::tool_digital)},
      {"standard_analog_output_mask",
       uint8,
       {},
       0,
       UR_INPUT(m.analog_mask = from.u8(); m.touched |= M::analog)},
      {"standard_analog_output_type",
       uint8,
       {},
       0,
       UR_INPUT(m.analog_types = from.u8(); m.touched |= M::analog)},
      {"standard_analog_output_0",
       double_,
       {},
       0,
       UR_INPUT(m.analog_values[0] = from.f64(); m.touched |= M::analog)},
      {"standard_analog_output_1",
       double_,
       {},
       0,
       UR_INPUT(m.analog_values[1] = from.f64(); m.touched |= M::analog)},
      {"external_force_torque",
       vector6d,
       {},
       0,
       UR_INPUT(const Vector6 wrench = from.vector6();
                if (wrench.allFinite()) { s.external_force_torque = wrench; })},
  };
  fields.insert(fields.end(), rows.begin(), rows.end());
}

#undef UR_INPUT

/// Sets the bits of `outputs` from `shift` on that the mask selects.
void set_bits(std::uint64_t & outputs, unsigned shift, std::uint8_t mask, std::uint8_t values)
{
  const std::uint64_t selected = static_cast<std::uint64_t>(mask) << shift;
  outputs = (outputs & ~selected) | ((static_cast<std::uint64_t>(values) << shift) & selected);
}

void apply_speed_slider(const MaskedInputs & masked, State & state)
{
  if (masked.speed_slider_mask != 0 && std::isfinite(masked.speed_slider_fraction)) {
    state.speed_slider = std::clamp(masked.speed_slider_fraction, 0.0, 1.0);
  }
}

/// RTDE carries the output as a fraction 0..1 of its range: 4..20 mA (type bit 0) or 0..10 V (type bit 1).
void apply_analog(const MaskedInputs & masked, State & state)
{
  for (unsigned i = 0; i < 2; ++i) {
    const unsigned selected = 1u << i;
    if ((masked.analog_mask & selected) == 0 || !std::isfinite(masked.analog_values[i])) {
      continue;
    }
    const double fraction = std::clamp(masked.analog_values[i], 0.0, 1.0);
    const bool voltage = (masked.analog_types & selected) != 0;
    const std::uint32_t domain = 1u << (2 + i);
    state.io.analog_io_types =
        voltage ? state.io.analog_io_types | domain : state.io.analog_io_types & ~domain;
    state.io.analog_outputs[i] = voltage ? 10.0 * fraction : 0.004 + 0.016 * fraction;
  }
}

}  // namespace

const std::vector<InputField> & input_fields()
{
  static const std::vector<InputField> fields = [] {
    std::vector<InputField> all;
    add_registers(all);
    add_masked(all);
    std::ranges::sort(all, {}, &InputField::name);
    return all;
  }();
  return fields;
}

const InputField * find_input(std::string_view name, const PolyscopeVersion & version)
{
  const auto & fields = input_fields();
  const auto found = std::ranges::lower_bound(fields, name, {}, &InputField::name);
  const bool exists = found != fields.end() && found->name == name && found->since.holds_for(version);
  return exists ? &*found : nullptr;
}

void apply(MaskedInputs & masked, State & state)
{
  const unsigned touched = masked.touched;
  masked.touched = 0;
  if ((touched & MaskedInputs::speed_slider) != 0) {
    apply_speed_slider(masked, state);
  }
  if ((touched & MaskedInputs::standard_digital) != 0) {
    set_bits(state.io.digital_outputs, 0, masked.standard_digital_mask, masked.standard_digital_values);
  }
  if ((touched & MaskedInputs::configurable_digital) != 0) {
    set_bits(state.io.digital_outputs, 8, masked.configurable_digital_mask,
             masked.configurable_digital_values);
  }
  if ((touched & MaskedInputs::tool_digital) != 0) {
    const std::uint8_t mask = masked.tool_digital_mask & 0x3;
    set_bits(state.io.digital_outputs, 16, mask, masked.tool_digital_values);
  }
  if ((touched & MaskedInputs::analog) != 0) {
    apply_analog(masked, state);
  }
}

}  // namespace ur_simulator::rtde
