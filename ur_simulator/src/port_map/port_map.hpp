#pragma once

#include <cstdint>
#include <optional>

#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator {

/// Whether a value can be written to an address of the port map.
enum class PortWrite : std::uint8_t { possible, illegal_address, illegal_value };

/// The registers and bits (coils) of the robot's MODBUS server, which programs access with
/// read_port_register() and the like (UR, "Modbus Server - 16377"). Reserved addresses and those that can
/// only be written read as 0.
class PortMap {
 public:
  static constexpr unsigned register_count = 2054;
  static constexpr unsigned bit_count = 628;

  /// `state` must outlive the map.
  PortMap(ControllerState & state, const PolyscopeVersion & version) : state_(state), version_(version) {}

  /// Nothing if there is no such address.
  std::optional<std::uint16_t> read_register(unsigned address) const;
  std::optional<bool> read_bit(unsigned address) const;
  PortWrite check_register(unsigned address, std::uint16_t value) const;
  PortWrite check_bit(unsigned address, bool value) const;
  /// Has no effect if check_register() or check_bit() does not return `possible`.
  void write_register(unsigned address, std::uint16_t value);
  void write_bit(unsigned address, bool value);

 private:
  ControllerState & state_;
  PolyscopeVersion version_;
};

}  // namespace ur_simulator
