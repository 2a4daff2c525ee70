#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "program/control_scripts.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/connection/reporter.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// What the numbers of the registers begin at.
constexpr int register_offset(const RobotOptions & options)
{
  return options.upper_range_registers ? 24 : 0;
}

/// Makes and drops ur_rtde's control and IO interfaces. Each is constructed outside of locks, after a look at
/// the ports it needs; whatever it throws becomes an Error. Thread-safe.
class InterfaceLinks {
 public:
  /// `scripts` outlives it.
  InterfaceLinks(const RobotOptions & options, ControlScripts & scripts, LogFunction log)
      : options_(options), scripts_(scripts), log_(std::move(log))
  {
  }
  ~InterfaceLinks() { drop(); }

  /// Takes as long as the connect timeout; does nothing when there is one that works.
  Status ensure_io();
  /// Uploads and starts the control program, then its watchdog. Up to some seconds if the robot does not
  /// start it. The program that ran before must have been stopped. Over the parked connection, if there is
  /// one that works.
  Status start_control(const ControllerVersion & version);
  /// For a program that somebody else starts: connects, and gives it signs of life, before it runs. Does
  /// nothing when that has been done.
  Status prepare_control();
  /// Whether the program that runs is the control program, by its signs of life; waits for them up to
  /// `limit`.
  bool prepared_program_lives(std::chrono::milliseconds limit) const;
  /// Starts the watchdog of that program; from then on there is a control interface.
  Status take_prepared();
  /// Ends the control program and keeps its connection, over which the signs of life go on: another program
  /// is to run in its place. There is no control interface until start_control().
  void park_control();
  bool control_parked() const;
  /// Ends the connection; a command that waits in it returns. Returns when the robot can take another control
  /// interface.
  void drop_control();
  void drop();

  std::shared_ptr<ur_rtde::RTDEControlInterface> control_pointer() const;
  std::optional<Locked<ur_rtde::RTDEControlInterface>> control() const;
  std::optional<Locked<ur_rtde::RTDEIOInterface>> io() const;
  const std::shared_ptr<InterfaceLock> & control_lock() const { return control_lock_; }
  /// The control program has given no sign of life for some time, though nothing keeps it from it: another
  /// one runs in its place.
  bool control_silent() const;
  /// A sign of life for the control program's watchdog. Does not wait for a command under way.
  void kick_watchdog();

 private:
  Status reach_control_ports() const;
  /// What an interface's constructor has thrown, which `what` begins to tell.
  Error refused(std::string_view what, const std::exception & error) const;
  std::shared_ptr<ur_rtde::RTDEControlInterface> connect_control(const std::string & script) const;
  Status start_watchdog(ur_rtde::RTDEControlInterface & control) const;
  /// Leaves out the extensions that the controller does not take.
  Status check_extensions(const ControllerVersion & version);
  /// The lock of the control interface, giving a command that holds it up; false when that does not help.
  bool take_control_lock(ur_rtde::RTDEControlInterface & control, int attempts);
  bool resume_parked();

  const RobotOptions options_;
  ControlScripts & scripts_;
  const LogFunction log_;
  // Used by the supervisor's thread only.
  bool extensions_checked_ = false;
  Reporter extensions_reporter_{log_};
  mutable std::mutex mutex_;
  std::shared_ptr<ur_rtde::RTDEControlInterface> control_;
  std::shared_ptr<ur_rtde::RTDEControlInterface> parked_;
  std::shared_ptr<ur_rtde::RTDEIOInterface> io_;
  std::shared_ptr<InterfaceLock> control_lock_ = std::make_shared<InterfaceLock>();
  std::shared_ptr<InterfaceLock> io_lock_ = std::make_shared<InterfaceLock>();
};

}  // namespace ur_ros_rtde
