#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rtde/package_encoding.hpp"
#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::rtde {

/// An RTDE output (UR, "RTDE Guide", "Robot controller outputs"). Each register is a field of its own.
struct OutputField {
  std::string name;
  FieldType type;
  MinVersion min_version;
  unsigned index;  ///< number of the register; 0 for other fields
  void (*write)(const ControllerState & state, unsigned index, PackageWriter & to);
};

/// The inputs of one client that take effect under a mask: last received values, and the groups that the
/// current data package contains.
struct MaskedInputs {
  enum Group : unsigned {
    speed_slider = 1,
    standard_digital = 2,
    configurable_digital = 4,
    tool_digital = 8,
    analog = 16
  };

  unsigned updated_groups = 0;
  std::uint32_t speed_slider_mask = 0;
  double speed_slider_fraction = 1.0;
  std::uint8_t standard_digital_mask = 0, standard_digital_values = 0;
  std::uint8_t configurable_digital_mask = 0, configurable_digital_values = 0;
  std::uint8_t tool_digital_mask = 0, tool_digital_values = 0;
  std::uint8_t analog_mask = 0, analog_types = 0;
  double analog_values[2] = {0.0, 0.0};
};

/// An RTDE input (UR, "RTDE Guide", "Robot controller inputs"). Only one client at a time may use it.
struct InputField {
  std::string name;
  FieldType type;
  MinVersion min_version;
  unsigned index;  ///< number of the register; 0 for other fields
  void (*read)(PackageReader & from, unsigned index, ControllerState & state, MaskedInputs & masked);
};

/// All fields of PolyScope 3 and 5, sorted by name. `min_version`: for each controller generation, the
/// first version that has the field.
const std::vector<OutputField> & output_fields();
const std::vector<InputField> & input_fields();

/// The field with this name, or nullptr if the version has none.
const OutputField * find_output_field(std::string_view name, const PolyscopeVersion & version);
const InputField * find_input_field(std::string_view name, const PolyscopeVersion & version);

/// Applies the groups that the current data package contains to the state.
void apply_masked_inputs(MaskedInputs & masked, ControllerState & state);

}  // namespace ur_simulator::rtde
