#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::primary {

/// The packet that port 30003 sends in each cycle: a 4-byte size and big-endian doubles. UR, "Client
/// Interface", sheets "RealTime 5.4" (1116 bytes) and "RealTime 5.10" (1220). PolyScope 3 ends with the
/// program state (1060 bytes), from 3.5 on with the velocity of the elbow (1108, the size that public clients
/// of CB3 robots read).
class RealtimePacket {
 public:
  explicit RealtimePacket(const PolyscopeVersion & version);
  /// The result is valid until the next call.
  std::string_view encode(const ControllerState & state);

 private:
  void put(double value);
  template <typename Derived>
  void put(const Eigen::MatrixBase<Derived> & values);
  void put_zeros(int count);
  void put_motion(const ControllerState & state);
  void put_status(const ControllerState & state);

  std::size_t size_;
  std::string bytes_;
};

}  // namespace ur_simulator::primary
