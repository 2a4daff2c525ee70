#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "rtde/fields.hpp"

namespace ur_simulator::testing {
namespace {

using Version = std::optional<std::string>;

/// An output of UR's RTDE guide with its type and the first version of each controller generation that has
/// it; nullopt: never. The general purpose registers are tested with the protocol.
struct DocumentedOutput {
  std::string name;
  std::string type;
  Version e_series = "5.0";
  Version cb3 = "3.0";
};

const std::vector<DocumentedOutput> documented_outputs{
    {"timestamp", "DOUBLE"},
    {"target_q", "VECTOR6D"},
    {"target_qd", "VECTOR6D"},
    {"target_qdd", "VECTOR6D"},
    {"target_current", "VECTOR6D"},
    {"target_moment", "VECTOR6D"},
    {"actual_q", "VECTOR6D"},
    {"actual_qd", "VECTOR6D"},
    {"actual_current", "VECTOR6D"},
    {"actual_current_window", "VECTOR6D"},
    {"actual_current_as_torque", "VECTOR6D", "5.23", std::nullopt},
    {"joint_control_output", "VECTOR6D"},
    {"actual_TCP_pose", "VECTOR6D"},
    {"actual_TCP_speed", "VECTOR6D"},
    {"actual_TCP_force", "VECTOR6D"},
    {"target_TCP_pose", "VECTOR6D"},
    {"target_TCP_speed", "VECTOR6D"},
    {"tcp_offset", "VECTOR6D", "5.5.1", "3.12"},
    {"actual_TCP_acceleration", "VECTOR6D", "5.23", std::nullopt},
    {"target_TCP_acceleration", "VECTOR6D", "5.23", std::nullopt},
    {"actual_digital_input_bits", "UINT64"},
    {"actual_configurable_digital_input_bits", "UINT64", "5.23", std::nullopt},
    {"joint_temperatures", "VECTOR6D"},
    {"actual_execution_time", "DOUBLE"},
    {"target_execution_time", "DOUBLE", "5.23", std::nullopt},
    {"robot_mode", "INT32"},
    {"joint_mode", "VECTOR6INT32"},
    {"safety_mode", "INT32"},
    {"safety_status", "INT32", "5.4", "3.10"},
    {"actual_tool_accelerometer", "VECTOR3D"},
    {"speed_scaling", "DOUBLE"},
    {"target_speed_fraction", "DOUBLE"},
    {"actual_momentum", "DOUBLE"},
    {"actual_main_voltage", "DOUBLE"},
    {"actual_robot_voltage", "DOUBLE"},
    {"actual_robot_current", "DOUBLE"},
    {"actual_joint_voltage", "VECTOR6D"},
    {"actual_digital_output_bits", "UINT64"},
    {"actual_configurable_digital_output_bits", "UINT64", "5.23", std::nullopt},
    {"runtime_state", "UINT32"},
    {"elbow_position", "VECTOR3D", "5.0", "3.5"},
    {"elbow_velocity", "VECTOR3D", "5.0", "3.5"},
    {"robot_status_bits", "UINT32"},
    {"safety_status_bits", "UINT32"},
    {"analog_io_types", "UINT32"},
    {"standard_analog_input0", "DOUBLE"},
    {"standard_analog_input1", "DOUBLE"},
    {"standard_analog_output0", "DOUBLE"},
    {"standard_analog_output1", "DOUBLE"},
    {"io_current", "DOUBLE"},
    {"output_bit_registers0_to_31", "UINT32"},
    {"output_bit_registers32_to_63", "UINT32"},
    {"actual_robot_energy_consumed", "DOUBLE", "5.23", std::nullopt},
    {"actual_robot_braking_energy_dissipated", "DOUBLE", "5.23", std::nullopt},
    {"encoder0_raw", "INT32", "5.23", std::nullopt},
    {"encoder1_raw", "INT32", "5.23", std::nullopt},
    {"euromap67_input_bits", "UINT32"},
    {"euromap67_output_bits", "UINT32"},
    {"euromap67_24V_voltage", "DOUBLE"},
    {"euromap67_24V_current", "DOUBLE"},
    {"tool_mode", "UINT32"},
    {"tool_analog_input_types", "UINT32"},
    {"tool_analog_input0", "DOUBLE"},
    {"tool_analog_input1", "DOUBLE"},
    {"tool_output_voltage", "INT32"},
    {"tool_output_current", "DOUBLE"},
    {"tool_temperature", "DOUBLE"},
    {"tool_output_mode", "UINT8", "5.0", std::nullopt},
    {"tool_digital_output0_mode", "UINT8", "5.0", std::nullopt},
    {"tool_digital_output1_mode", "UINT8", "5.0", std::nullopt},
    {"tcp_force_scalar", "DOUBLE"},
    {"joint_position_deviation_ratio", "DOUBLE", "5.14", std::nullopt},
    {"collision_detection_ratio", "DOUBLE", "5.15", std::nullopt},
    {"ft_raw_wrench", "VECTOR6D", "5.9", std::nullopt},
    {"wrench_calc_from_currents", "VECTOR6D", "5.23", std::nullopt},
    {"payload", "DOUBLE", "5.5.1", "3.11"},
    {"payload_cog", "VECTOR3D", "5.5.1", "3.11"},
    {"payload_inertia", "VECTOR6D", "5.11", "3.15"},
    {"script_control_line", "UINT32", "5.9", "3.14"},
    {"time_scale_source", "INT32", "5.17", std::nullopt},
    {"target_gravity", "VECTOR3D", "5.26", std::nullopt},
    {"target_base_acceleration", "VECTOR6D", "5.26", std::nullopt},
    {"control_step", "UINT64", "5.26", std::nullopt},
    {"target_base_wrench", "VECTOR6D", "5.26", std::nullopt},
};

void expect_first_version(const DocumentedOutput & output, const Version & first,
                          const std::vector<std::string> & versions)
{
  for (const std::string & text : versions) {
    const PolyscopeVersion version = *PolyscopeVersion::parse(text);
    const rtde::OutputField * const field = rtde::find_output_field(output.name, version);
    EXPECT_EQ(field != nullptr, first && version >= *PolyscopeVersion::parse(*first))
        << output.name << " in " << text;
    if (field != nullptr) {
      EXPECT_EQ(rtde::type_name(field->type), output.type) << output.name;
    }
  }
}

TEST(RtdeOutputTest, HasEachOutputOfTheGuideFromItsFirstVersion)
{
  for (const DocumentedOutput & output : documented_outputs) {
    expect_first_version(output, output.e_series,
                         {"5.0", "5.4", "5.5.1", "5.9", "5.11", "5.13", "5.14", "5.15", "5.16", "5.17",
                          "5.22", "5.23", "5.25.1", "5.26"});
    expect_first_version(output, output.cb3,
                         {"3.0", "3.4", "3.5", "3.9", "3.10", "3.11", "3.12", "3.14", "3.15.8"});
  }
}

TEST(RtdeOutputTest, WritesAsManyBytesAsItsType)
{
  const ControllerState state;
  for (const rtde::OutputField & field : rtde::output_fields()) {
    // Bytes behind the value must not change.
    std::array<char, 64> before, after;
    before.fill('\x5a');
    after = before;
    rtde::PackageWriter writer(after.data());
    field.write(state, field.index, writer);
    const std::size_t size = rtde::encoded_size(field.type);
    EXPECT_TRUE(std::equal(after.begin() + static_cast<std::ptrdiff_t>(size), after.end(),
                           before.begin() + static_cast<std::ptrdiff_t>(size)))
        << field.name;
  }
}

TEST(RtdeOutputTest, TimeScaleSourceDependsOnTheProgram)
{
  ControllerState state;
  const rtde::OutputField * const field =
      rtde::find_output_field("time_scale_source", *PolyscopeVersion::parse("5.25"));
  ASSERT_NE(field, nullptr);
  const auto value = [&] {
    std::array<char, 4> bytes{};
    rtde::PackageWriter writer(bytes.data());
    field->write(state, field->index, writer);
    return static_cast<int>(bytes[3]);
  };
  EXPECT_EQ(value(), 0);
  state.runtime_state = RuntimeState::playing;
  EXPECT_EQ(value(), 1);
  state.time_scale_source = TimeScaleSource::joint_speed_limit;
  EXPECT_EQ(value(), 10);
}

}  // namespace
}  // namespace ur_simulator::testing
