#include "connection/rtde/rtde_interfaces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ur_rtde/rtde.h>
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_io_interface.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "connection/ports.hpp"
#include "connection/script_check.hpp"
#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"
#include "ur_ros_rtde_robot/script/extension_registers.hpp"

namespace ur_ros_rtde {
namespace {

using ur_rtde::RTDEControlInterface;
using ur_rtde::RTDEIOInterface;

constexpr double controllers_frequency = -1.0;
/// A running control program answers its first command within some cycles.
constexpr std::chrono::seconds answer_timeout(1);
constexpr std::chrono::milliseconds close_timeout(1000);

std::uint16_t control_flags(const RobotOptions & options)
{
  unsigned flags = options.control_mode == ControlMode::upload
                       ? RTDEControlInterface::FLAG_UPLOAD_SCRIPT
                       : RTDEControlInterface::FLAG_NO_WAIT;  // the program comes from a ScriptServer
  // ControlProgramManager has checked it, with a better message.
  flags |= RTDEControlInterface::FLAG_DISABLE_REMOTE_CONTROL_CHECK;
  if (options.upper_range_registers) {
    flags |= RTDEControlInterface::FLAG_UPPER_RANGE_REGISTERS;
  }
  return static_cast<std::uint16_t>(flags);
}

constexpr std::string_view register_names = "input_";

/// Explains that another client has the inputs; the remedy depends on which inputs they are.
std::string inputs_in_use_message(const RobotOptions & options, const std::vector<std::string> & names)
{
  const bool registers_only = std::all_of(
      names.begin(), names.end(), [](const std::string & name) { return name.starts_with(register_names); });
  std::string who = "another driver or another RTDE client is connected to it: stop that one";
  if (registers_only) {
    who += fmt::format(
        "; or its installation has a fieldbus (EtherNet/IP, PROFINET, MODBUS): switch that off, or start "
        "this driver with register_range:={} (now {})",
        options.upper_range_registers ? "lower" : "upper", options.upper_range_registers ? "upper" : "lower");
  }
  constexpr std::size_t listed = 4;
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), listed)));
  const std::string more = names.size() > listed ? fmt::format(" and {} more", names.size() - listed) : "";
  return fmt::format("inputs of the robot at {} are in use ({}{}): {}", options.address,
                     fmt::join(first, ", "), more, who);
}

}  // namespace

Error RtdeInterfaces::connection_error(std::string_view what, const std::exception & error) const
{
  if (const auto * used = dynamic_cast<const ur_rtde::InputsInUseError *>(&error)) {
    return {ErrorCode::robot_in_use, inputs_in_use_message(options_, used->names())};
  }
  const bool overtaken = dynamic_cast<const ur_rtde::ProgramRunningError *>(&error) != nullptr;
  return {overtaken ? ErrorCode::program_stopped : ErrorCode::not_ready,
          fmt::format("{}: {}", what, printable(error.what()))};
}

bool RtdeInterfaces::is_io_open() const
{
  const std::lock_guard lock(mutex_);
  return io_ && io_->isConnected();
}

Status RtdeInterfaces::ensure_io()
{
  if (is_io_open()) {
    return {};
  }
  if (const auto reachable = TcpSocket::connect(options_.address, rtde_port, options_.connect_timeout);
      !reachable) {
    return tl::unexpected(reachable.error());
  }
  try {
    auto io = std::make_shared<RTDEIOInterface>(options_.address, false, options_.upper_range_registers,
                                                keep_priority);
    // The controller keeps the values of a previous connection: no extension is to run.
    if (!io->setInputDoubleRegister(script::trigger_register + register_offset(options_), 0.0)) {
      return failure(ErrorCode::link_lost, "the IO interface accepts no values");
    }
    {
      const std::lock_guard lock(mutex_);
      io_.swap(io);
      ++io_starts_;
    }
    return {};  // the previous interface is closed here
  } catch (const std::exception & error) {
    return tl::unexpected(connection_error("the robot rejects the IO interface", error));
  }
}

Status RtdeInterfaces::start_watchdog(RTDEControlInterface & control)
{
  // Other threads may have the interface already.
  const HeldLock lock = acquire(*control_lock_, "control interface", answer_timeout);
  control.setCommandTimeout(answer_timeout);
  const bool started = options_.watchdog_frequency == 0.0 || control.setWatchdog(options_.watchdog_frequency);
  control.setCommandTimeout(std::chrono::seconds(UR_EXECUTION_TIMEOUT));
  if (!started) {
    return failure(ErrorCode::not_ready,
                   "the control program does not answer: look at the log of the pendant for what ended it");
  }
  watchdog_frequency_ = options_.watchdog_frequency;
  return {};
}

Status RtdeInterfaces::set_watchdog(double frequency)
{
  const auto interface = control();
  if (!interface) {
    return failure(ErrorCode::not_ready, "the control program does not run");
  }
  if (!(*interface)->setWatchdog(frequency)) {
    return failure(ErrorCode::rejected_by_robot, "the control program did not set its watchdog");
  }
  watchdog_frequency_ = frequency;
  return {};
}

Status RtdeInterfaces::check_extensions(const ControllerVersion & version)
{
  if (!extensions_checked_) {
    scripts_.leave_out_unfit(version);
  }
  while (!extensions_checked_ && scripts_.has_extensions()) {
    const auto rejection =
        check_definitions(options_.address, scripts_.text(version), options_.connect_timeout);
    if (!rejection) {
      return tl::unexpected(rejection.error());
    }
    if (!*rejection) {
      break;
    }
    const auto left_out = scripts_.leave_out(version, (*rejection)->line, (*rejection)->text);
    if (!left_out) {
      return failure(ErrorCode::not_ready,
                     fmt::format("the controller does not take the control program: {}", (*rejection)->text));
    }
    if (left_out->urcap.empty()) {
      log_(LogLevel::error, fmt::format("the extension {} is left out: {}", left_out->name, left_out->why));
    }
  }
  extensions_checked_ = true;
  extensions_logger_.log_on_change(LogLevel::info, scripts_.missing_urcaps_message());
  return {};
}

Status RtdeInterfaces::probe_control_ports() const
{
  for (const auto port : {rtde_port, script_port}) {
    if (const auto reachable = TcpSocket::connect(options_.address, port, options_.connect_timeout);
        !reachable) {
      return tl::unexpected(reachable.error());
    }
  }
  return {};
}

std::shared_ptr<RTDEControlInterface> RtdeInterfaces::connect_control(const std::string & script) const
{
  auto control =
      std::make_shared<RTDEControlInterface>(options_.address, controllers_frequency, control_flags(options_),
                                             options_.urcap_port, keep_priority, script);
  // Between the steps of these functions, no stop finds what they are about to start.
  control->rejectScripts(
      "not in this driver: a script or a path that is sent by ur_rtde cannot be stopped; use "
      "Run::run_script() or the command move_path");
  // The state receiver closes the connection after silence_limit.
  control->setPackageTimeout(
      std::max(options_.silence_limit, std::chrono::milliseconds(RTDE_PACKAGE_TIMEOUT_MS)));
  return control;
}

std::shared_ptr<RTDEControlInterface> RtdeInterfaces::activate(std::shared_ptr<RTDEControlInterface> control,
                                                               bool after_script)
{
  const Starts before = starts_;
  starts_ = {before.number + 1, before.after_script + (after_script ? 1 : 0)};
  lost_control_ = !control && (lost_control_ || (control_ && !control_->isConnected()));
  return std::exchange(control_, std::move(control));
}

Status RtdeInterfaces::start_control(const ControllerVersion & version, const std::stop_token & stop)
{
  if (resume_suspended(stop)) {
    return {};
  }
  if (const auto reachable = probe_control_ports(); !reachable) {
    return reachable;
  }
  if (const auto checked = check_extensions(version); !checked) {
    return checked;
  }
  try {
    auto control = connect_control(scripts_.text(version));
    {
      // From here on the watchdog is fed. That must have begun before start_watchdog().
      const std::lock_guard lock(mutex_);
      activate(control);
    }
    auto started = start_watchdog(*control);
    if (!started) {
      ++failed_starts_;
      close_control();
    }
    return started;
  } catch (const std::exception & error) {
    ++failed_starts_;
    close_control();
    extensions_checked_ = false;  // a URCap may have been removed
    return tl::unexpected(connection_error("the control program cannot be started", error));
  }
}

HeldLock RtdeInterfaces::take_control_lock(RTDEControlInterface & control,
                                           std::chrono::milliseconds timeout) const
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  do {
    control.abandonCommand();
    if (control_lock_->try_lock_for(std::chrono::milliseconds(2), InterfaceLock::Place::first)) {
      return held(control_lock_.get());
    }
  } while (std::chrono::steady_clock::now() < deadline);
  return held(nullptr);
}

bool RtdeInterfaces::resume_suspended(const std::stop_token & stop)
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = pending_;
  }
  const bool is_connected = control && control->isConnected();
  bool works = false;
  try {
    if (is_connected) {
      // Other threads may have kept the interface.
      const HeldLock lock = acquire(*control_lock_, "control interface", answer_timeout);
      works = control->reuploadScript();
    }
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (works && !control->isProgramRunning()) {
      works = !stop.stop_requested() && control->waitForNextState() &&
              std::chrono::steady_clock::now() < deadline;
    }
    works = works && start_watchdog(*control);
  } catch (const std::exception &) {
    works = false;
  }
  {
    const std::lock_guard lock(mutex_);
    pending_.reset();
    if (works) {
      activate(control, true);
    }
  }
  if (control && !works) {
    failed_starts_ += is_connected ? 1 : 0;
    disconnect(*control);
  }
  return works;
}

void RtdeInterfaces::close_control()
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = control_ ? activate(nullptr) : pending_;
    pending_.reset();
  }
  if (control) {
    disconnect(*control);
  }
}

/// The robot gives each input register to one client: this connection must be closed before the next one is
/// opened. If another thread keeps the interface, it is closed when that thread lets it go.
void RtdeInterfaces::disconnect(RTDEControlInterface & control) const
{
  if (const HeldLock lock = take_control_lock(control, close_timeout)) {
    control.disconnect();
  }
}

void RtdeInterfaces::close()
{
  close_control();
  std::shared_ptr<RTDEIOInterface> io;  // closed after the lock is released
  const std::lock_guard lock(mutex_);
  io.swap(io_);
}

std::shared_ptr<RTDEControlInterface> RtdeInterfaces::control_interface() const
{
  const std::lock_guard lock(mutex_);
  return control_;
}

std::shared_ptr<RTDEControlInterface> RtdeInterfaces::active_or_pending() const
{
  const std::lock_guard lock(mutex_);
  return control_ ? control_ : pending_;
}

std::optional<Locked<RTDEControlInterface>> RtdeInterfaces::control() const
{
  const std::lock_guard lock(mutex_);
  return control_ ? std::optional(Locked(control_, control_lock_, "control interface")) : std::nullopt;
}

std::optional<Locked<RTDEControlInterface>> RtdeInterfaces::control_for_queries() const
{
  const auto interface = control_interface();
  if (!interface) {
    return std::nullopt;
  }
  const auto reject_motions = [interface]() -> std::shared_ptr<void> {
    const char * const before = interface->rejectMotions(
        "a function that moves the arm or ends its program needs a lease of the arm: the traits() of the "
        "command have to name Resource::motion, Resource::mode or Resource::script");
    return {nullptr, [interface, before](void *) { interface->rejectMotions(before); }};
  };
  return Locked(interface, control_lock_, "control interface").permitted_by(reject_motions);
}

std::optional<Locked<RTDEIOInterface>> RtdeInterfaces::io() const
{
  const std::lock_guard lock(mutex_);
  return io_ ? std::optional(Locked(io_, io_lock_, "IO interface")) : std::nullopt;
}

bool RtdeInterfaces::control_heartbeat_lost() const
{
  constexpr std::chrono::milliseconds heartbeat_timeout(50);
  const auto control = active_or_pending();
  return control && control->getTimeSinceHeartbeat() > heartbeat_timeout;
}

bool RtdeInterfaces::has_lost_control() const
{
  const std::lock_guard lock(mutex_);
  const auto & control = control_ ? control_ : pending_;
  return lost_control_ || (control && !control->isConnected());
}

void RtdeInterfaces::kick_watchdog()
{
  if (const auto control = active_or_pending()) {
    control->kickWatchdog();
  }
}

}  // namespace ur_ros_rtde
