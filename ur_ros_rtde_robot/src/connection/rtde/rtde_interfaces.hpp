#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include "connection/rtde/control_scripts.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/robot_options.hpp"

namespace ur_rtde {
class RTDEControlInterface;
class RTDEIOInterface;
}  // namespace ur_rtde

namespace ur_ros_rtde {

/// Index of the first general purpose register that the driver uses.
constexpr int register_offset(const RobotOptions & options)
{
  return options.upper_range_registers ? 24 : 0;
}

/// Opens and closes ur_rtde's control and IO interfaces. Each interface is constructed outside of locks,
/// after its ports have been probed. Exceptions of its constructor are returned as Error. Thread-safe.
///
/// A control interface is active or pending. Only an active one is returned by control(). The control program
/// of a pending one does not run: it was suspended, or the External Control URCap has not started it yet.
/// Both receive the watchdog's heartbeat.
class RtdeInterfaces {
 public:
  /// `scripts` must outlive this object.
  RtdeInterfaces(const RobotOptions & options, ControlScripts & scripts, LogFunction log)
      : options_(options), scripts_(scripts), log_(std::move(log))
  {
  }
  ~RtdeInterfaces() { close(); }

  /// Opens the IO interface unless it is open. Takes up to the connect timeout.
  Status ensure_io();
  bool is_io_open() const;
  /// How often the IO interface was opened, which clears the trigger of the extensions.
  std::uint32_t io_starts() const { return io_starts_; }
  /// Uploads and starts the control program, then its watchdog. Reuses the pending connection if it is
  /// usable. May take several seconds if the robot does not start the program. The previous program must have
  /// been stopped.
  Status start_control(const ControllerVersion & version, const std::stop_token & stop);
  /// Opens a pending connection for a program that the URCap will start. Does nothing if there is one.
  Status connect_pending_control();
  /// Whether the running program is the control program, judged by its heartbeat; waits for it up to
  /// `timeout`.
  bool pending_program_alive(std::chrono::milliseconds timeout, const std::stop_token & stop) const;
  /// Starts the watchdog of the pending connection's program and makes the connection active.
  Status adopt_control();
  /// Ends the control program and makes its connection pending, until start_control(). False unless the
  /// program has ended because of this: it hangs, was stopped, or another one runs, or ran, in its place.
  bool suspend_control();
  /// Whether there is a pending connection.
  bool has_pending_control() const;
  /// Whether it is open and shows a program that plays. Its packages are received by a thread of its own.
  bool pending_program_plays() const;
  /// Closes the active or pending connection. A command that waits in it returns. When this returns, the
  /// robot accepts another control interface, unless a thread has kept this one for a second.
  void close_control();
  /// Closes the control and the IO interface.
  void close();

  std::shared_ptr<ur_rtde::RTDEControlInterface> control_interface() const;
  std::optional<Locked<ur_rtde::RTDEControlInterface>> control() const;
  /// The same, but functions that start a motion or end the program throw std::logic_error.
  std::optional<Locked<ur_rtde::RTDEControlInterface>> control_for_queries() const;
  std::optional<Locked<ur_rtde::RTDEIOInterface>> io() const;
  /// Locks the control interface before all threads that wait for it, abandoning the command that holds the
  /// lock. Null after `timeout`.
  HeldLock take_control_lock(ur_rtde::RTDEControlInterface & control,
                             std::chrono::milliseconds timeout) const;
  /// A start: a control program becomes active, or is given up.
  struct Starts {
    std::uint32_t number = 0;
    std::uint32_t after_script = 0;  ///< of these, the ones in which the suspended program goes on
  };
  Starts starts() const { return starts_; }
  /// Incremented when a control program that was sent does not answer.
  std::uint32_t failed_starts() const { return failed_starts_; }
  /// The control program of the active or pending connection has missed its heartbeat although no command
  /// delays it: a program that runs is another one.
  bool control_heartbeat_lost() const;
  /// Whether the connection to the newest control program was lost: closed, but not by the driver.
  bool has_lost_control() const;
  /// Sends a heartbeat to the control program's watchdog. Does not wait for a command under way.
  void kick_watchdog();
  /// Changes the watchdog of the running control program. Until the next one, which has that of the options.
  Status set_watchdog(double frequency);
  /// Hz, of the newest control program. 0: it has no watchdog.
  double watchdog_frequency() const { return watchdog_frequency_; }

 private:
  void disconnect(ur_rtde::RTDEControlInterface & control) const;
  Status probe_control_ports() const;
  /// Converts the exception of an interface's constructor; `what` begins the message.
  Error connection_error(std::string_view what, const std::exception & error) const;
  std::shared_ptr<ur_rtde::RTDEControlInterface> connect_control(const std::string & script) const;
  Status start_watchdog(ur_rtde::RTDEControlInterface & control);
  /// Excludes the extensions that the controller does not compile.
  Status check_extensions(const ControllerVersion & version);
  /// Makes `control` the active interface, or none. Hold mutex_. Returns the previous one.
  std::shared_ptr<ur_rtde::RTDEControlInterface> activate(
      std::shared_ptr<ur_rtde::RTDEControlInterface> control, bool after_script = false);
  std::shared_ptr<ur_rtde::RTDEControlInterface> active_or_pending() const;
  bool resume_suspended(const std::stop_token & stop);

  const RobotOptions options_;
  ControlScripts & scripts_;
  const LogFunction log_;
  // Used by the thread of ControlProgramManager only.
  bool extensions_checked_ = false;
  ChangeLogger extensions_logger_{log_};
  mutable std::mutex mutex_;
  std::shared_ptr<ur_rtde::RTDEControlInterface> control_;  ///< active
  std::shared_ptr<ur_rtde::RTDEControlInterface> pending_;
  bool lost_control_ = false;   ///< the one that was active last
  std::atomic<Starts> starts_;  ///< written with mutex_
  std::atomic<std::uint32_t> failed_starts_ = 0;
  std::atomic<double> watchdog_frequency_ = 0.0;
  std::shared_ptr<ur_rtde::RTDEIOInterface> io_;
  std::atomic<std::uint32_t> io_starts_ = 0;
  std::shared_ptr<InterfaceLock> control_lock_ = std::make_shared<InterfaceLock>();
  std::shared_ptr<InterfaceLock> io_lock_ = std::make_shared<InterfaceLock>();
};

}  // namespace ur_ros_rtde
