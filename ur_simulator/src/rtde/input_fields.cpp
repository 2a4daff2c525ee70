#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rtde/fields.hpp"
#include "state/io_values.hpp"

namespace ur_simulator::rtde {
namespace {

using State = ControllerState;

constexpr MinVersion upper_input_registers_since{{5, 3, 0, 0}, {3, 9, 0, 0}};

/// The function that reads an input with a C++ statement; `i` is the number of the register, `s` the state,
/// `m` the masked inputs.
#define UR_INPUT(statement)                                                                          \
  []([[maybe_unused]] PackageReader & from, [[maybe_unused]] unsigned i, [[maybe_unused]] State & s, \
     [[maybe_unused]] MaskedInputs & m) { statement; }

void add_registers(std::vector<InputField> & fields)
{
  using enum FieldType;
  const auto read_word =
      UR_INPUT(const std::uint32_t word = from.read_u32();
               for (unsigned b = 0; b < 32; ++b) { s.inputs.bits.set(32 * i + b, ((word >> b) & 1u) != 0); });
  fields.push_back({"input_bit_registers0_to_31", uint32, {}, 0, read_word});
  fields.push_back({"input_bit_registers32_to_63", uint32, {}, 1, read_word});
  for (unsigned n = 64; n < 128; ++n) {
    fields.push_back({fmt::format("input_bit_register_{}", n), boolean, upper_input_registers_since, n,
                      UR_INPUT(s.inputs.bits.set(i, from.read_u8() != 0))});
  }
  for (unsigned n = 0; n < 48; ++n) {
    const MinVersion min_version = n < 24 ? MinVersion{} : upper_input_registers_since;
    fields.push_back({fmt::format("input_int_register_{}", n), int32, min_version, n,
                      UR_INPUT(s.inputs.integers[i] = from.read_i32())});
    fields.push_back({fmt::format("input_double_register_{}", n), double_, min_version, n,
                      UR_INPUT(s.inputs.floats[i] = static_cast<float>(from.read_f64()))});
  }
}

void add_masked_inputs(std::vector<InputField> & fields)
{
  using enum FieldType;
  using M = MaskedInputs;
  const auto add = [&fields](const char * name, FieldType type, auto read) {
    fields.push_back({name, type, {}, 0, read});
  };
  add("speed_slider_mask", uint32,
      UR_INPUT(m.speed_slider_mask = from.read_u32(); m.updated_groups |= M::speed_slider));
  add("speed_slider_fraction", double_,
      UR_INPUT(m.speed_slider_fraction = from.read_f64(); m.updated_groups |= M::speed_slider));
  add("standard_digital_output_mask", uint8,
      UR_INPUT(m.standard_digital_mask = from.read_u8(); m.updated_groups |= M::standard_digital));
  add("standard_digital_output", uint8,
      UR_INPUT(m.standard_digital_values = from.read_u8(); m.updated_groups |= M::standard_digital));
  add("configurable_digital_output_mask", uint8,
      UR_INPUT(m.configurable_digital_mask = from.read_u8(); m.updated_groups |= M::configurable_digital));
  add("configurable_digital_output", uint8,
      UR_INPUT(m.configurable_digital_values = from.read_u8(); m.updated_groups |= M::configurable_digital));
  add("tool_digital_output_mask", uint8,
      UR_INPUT(m.tool_digital_mask = from.read_u8(); m.updated_groups |= M::tool_digital));
  add("tool_digital_output", uint8,
      UR_INPUT(m.tool_digital_values = from.read_u8(); m.updated_groups |= M::tool_digital));
  add("standard_analog_output_mask", uint8,
      UR_INPUT(m.analog_mask = from.read_u8(); m.updated_groups |= M::analog));
  add("standard_analog_output_type", uint8,
      UR_INPUT(m.analog_types = from.read_u8(); m.updated_groups |= M::analog));
  add("standard_analog_output_0", double_,
      UR_INPUT(m.analog_values[0] = from.read_f64(); m.updated_groups |= M::analog));
  add("standard_analog_output_1", double_,
      UR_INPUT(m.analog_values[1] = from.read_f64(); m.updated_groups |= M::analog));
}

void add_external_force_torque(std::vector<InputField> & fields)
{
  const auto read = UR_INPUT(const Vector6 wrench = from.read_vector6();
                             if (wrench.allFinite()) { s.external_force_torque = wrench; });
  fields.push_back({"external_force_torque", FieldType::vector6d, {}, 0, read});
}

#undef UR_INPUT

void apply_speed_slider(const MaskedInputs & masked, State & state)
{
  if (masked.speed_slider_mask != 0 && std::isfinite(masked.speed_slider_fraction)) {
    state.speed_slider = std::clamp(masked.speed_slider_fraction, 0.0, 1.0);
  }
}

/// RTDE transmits an analog output as a fraction 0..1 of its range: in mA (type bit clear) or V (type bit
/// set).
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
    state.io.analog_outputs[i] = analog_value(fraction, voltage);
  }
}

}  // namespace

const std::vector<InputField> & input_fields()
{
  static const std::vector<InputField> fields = [] {
    std::vector<InputField> all;
    add_registers(all);
    add_masked_inputs(all);
    add_external_force_torque(all);
    std::ranges::sort(all, {}, &InputField::name);
    return all;
  }();
  return fields;
}

void apply_masked_inputs(MaskedInputs & masked, State & state)
{
  const unsigned updated_groups = masked.updated_groups;
  masked.updated_groups = 0;
  if ((updated_groups & MaskedInputs::speed_slider) != 0) {
    apply_speed_slider(masked, state);
  }
  if ((updated_groups & MaskedInputs::standard_digital) != 0) {
    set_bits(state.io.digital_outputs, 0, masked.standard_digital_mask, masked.standard_digital_values);
  }
  if ((updated_groups & MaskedInputs::configurable_digital) != 0) {
    set_bits(state.io.digital_outputs, 8, masked.configurable_digital_mask,
             masked.configurable_digital_values);
  }
  if ((updated_groups & MaskedInputs::tool_digital) != 0) {
    const std::uint8_t mask = masked.tool_digital_mask & 0x3;
    set_bits(state.io.digital_outputs, 16, mask, masked.tool_digital_values);
  }
  if ((updated_groups & MaskedInputs::analog) != 0) {
    apply_analog(masked, state);
  }
}

}  // namespace ur_simulator::rtde
