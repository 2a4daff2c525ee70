#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "connection/rtde/rtde_interfaces.hpp"

namespace ur_ros_rtde {

/// Writes the general purpose input registers of the control program's extensions, by their numbers without
/// the offset of the upper range. Thread-safe.
class InputRegisters {
 public:
  InputRegisters(const RobotOptions & options, const RtdeInterfaces & interfaces)
      : offset_(register_offset(options)), interfaces_(interfaces)
  {
  }

  /// A parameter of an extension: register 19 to 22.
  Status set(int index, std::int32_t value) const;
  Status set(int index, double value) const;
  using Io = Locked<ur_rtde::RTDEIOInterface>;
  using Permission = Io::Permission;
  /// Starts the extension with this number, if `permission` succeeds when nothing can come in between any
  /// more.
  Status set_trigger(int id, const Permission & permission);
  /// Ends an extension that runs: its thread is killed, and the arm decelerates. For a stop: fails instead of
  /// waiting for a thread that holds the IO interface.
  Status clear_trigger();
  /// An extension was started in the current control program, and the trigger has not been cleared.
  bool extension_started() const;
  /// The connection over which the trigger is written.
  struct Connection {
    bool is_open = false;
    std::uint32_t starts = 0;  ///< RtdeInterfaces::io_starts()
  };
  Connection connection() const { return {interfaces_.is_io_open(), interfaces_.io_starts()}; }

 private:
  struct Trigger {
    int id = 0;
    std::uint32_t program = 0;  ///< RtdeInterfaces::starts()
  };

  static Status check(int index);
  /// Calls `write_to` with the locked IO interface. `what` names the value in the error.
  static Status write(const std::string & what, const std::optional<Io> & io,
                      const std::function<bool(ur_rtde::RTDEIOInterface &)> & write_to);
  Status write_trigger(int id, const std::optional<Io> & io);

  const int offset_;
  const RtdeInterfaces & interfaces_;
  std::atomic<Trigger> trigger_{};  ///< may be in the register
};

}  // namespace ur_ros_rtde
