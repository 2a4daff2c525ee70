#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rtde/wire.hpp"
#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::rtde {

/// A variable that the controller sends. Register families are one row each in the source and one field a
/// register here.
struct OutputField {
  std::string name;
  FieldType type;
  Since since;
  unsigned index;  ///< of the register; 0 for others
  void (*write)(const ControllerState & state, unsigned index, Writer & to);
};

/// The values of inputs that act only under a mask, as one client last sent them; `touched` tells which
/// groups came with the present package.
struct MaskedInputs {
  enum Group : unsigned {
    speed_slider = 1,
    standard_digital = 2,
    configurable_digital = 4,
    tool_digital = 8,
    analog = 16
  };

  unsigned touched = 0;
  std::uint32_t speed_slider_mask = 0;
  double speed_slider_fraction = 1.0;
  std::uint8_t standard_digital_mask = 0, standard_digital_values = 0;
  std::uint8_t configurable_digital_mask = 0, configurable_digital_values = 0;
  std::uint8_t tool_digital_mask = 0, tool_digital_values = 0;
  std::uint8_t analog_mask = 0, analog_types = 0;
  double analog_values[2] = {0.0, 0.0};
};

/// A variable that a client may write. Each belongs to one client at a time.
struct InputField {
  std::string name;
  FieldType type;
  Since since;
  unsigned index;
  void (*read)(Reader & from, unsigned index, ControllerState & state, MaskedInputs & masked);
};

/// All fields of PolyScope 3 and 5; which of them exist on a version: field.since.
const std::vector<OutputField> & output_fields();
const std::vector<InputField> & input_fields();

/// The field of that name that exists on that version, or nullptr.
const OutputField * find_output(std::string_view name, const PolyscopeVersion & version);
const InputField * find_input(std::string_view name, const PolyscopeVersion & version);

/// Carries out the groups that a package touched: bits and values under their masks.
void apply(MaskedInputs & masked, ControllerState & state);

}  // namespace ur_simulator::rtde
