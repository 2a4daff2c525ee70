#pragma once

#include <atomic>
#include <chrono>
#include <functional>

#include "connection/rtde/control_scripts.hpp"
#include "connection/rtde/input_registers.hpp"
#include "connection/rtde/rtde_interfaces.hpp"
#include "motion/arbiter.hpp"
#include "motion/motion_stopper.hpp"
#include "motion/motion_tracker.hpp"
#include "motion/started_activities.hpp"
#include "program/control_program_manager.hpp"
#include "program/execution/extension_runner.hpp"
#include "program/execution/script_runner.hpp"
#include "program/script_server.hpp"
#include "state/arm_model.hpp"
#include "state/zeroed_force.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_connection.hpp"
#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// The parts of a Robot and the flow of samples between them.
class Robot::Impl {
 public:
  Impl(RobotOptions robot_options, const LogFunction & log);
  ~Impl();

  void add(const Sample & sample);
  void feed_watchdog(const Sample & sample);
  Status set_watchdog(double frequency);
  /// Why there is no control or IO interface.
  Error unavailable_error() const;
  /// Why the newest program has ended.
  Error program_ended_error() const;
  Status motion_possible() const;
  Status ready_to_move() const;
  Generation generation() const;
  Status may_use(const Claim & claim) const;
  /// See Claim::excludes_force_mode.
  Status leaves_force_mode_alone(const Claim & claim) const;
  /// For a claim that is granted now.
  Expected<Generation> admit(const Claim & claim) const;
  bool wait_for_control_program(Permit::Clock::time_point deadline) const;

  const RobotOptions options;
  Arbiter arbiter;
  std::function<void(const Sample &)> sample_function;
  mutable MotionTracker tracker;  ///< thread-safe; any thread may add the newest sample
  StateReceiver state;
  DashboardConnection dashboard;
  ArmModel model;
  ControlScripts control_scripts;
  RtdeInterfaces interfaces;
  InputRegisters registers;
  StartedActivities activities;
  MotionStopper stopper;
  ScriptServer server;  ///< for ControlMode::control_urcap
  ControlProgramManager manager;
  ScriptRunner scripts;
  ExtensionRunner extensions;

 private:
  void end_program();
  void warn_of_zeroed_force(double force) const;

  const LogFunction log_;
  ZeroedForce zeroed_force_;                           ///< receiving thread only
  std::chrono::steady_clock::time_point last_kick_{};  ///< receiving thread only
  std::atomic<double> watchdog_frequency_;             ///< Hz, of the fastest watchdog that may be running
};

}  // namespace ur_ros_rtde
