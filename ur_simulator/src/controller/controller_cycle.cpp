#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "controller/controller.hpp"
#include "primary/messages.hpp"
#include "primary/robot_state.hpp"

namespace ur_simulator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double robot_state_period = 0.1;  // s

LogLevel log_level(SafetyEvent::Level level)
{
  switch (level) {
    case SafetyEvent::Level::information:
      return LogLevel::info;
    case SafetyEvent::Level::warning:
      return LogLevel::warning;
    case SafetyEvent::Level::error:
      return LogLevel::error;
  }
  return LogLevel::error;
}

}  // namespace

void Controller::run_cycle()
{
  const Clock::time_point begin = Clock::now();
  ++state_.cycle;
  state_.timestamp = static_cast<double>(state_.cycle) * version_.cycle_time();
  log_.set_time(state_.timestamp);
  event_timeline_.cycle(control_port_context_);
  if (!switch_on_time_) {
    run_robot_cycle();
    publish_state();
  } else if (state_.timestamp >= *switch_on_time_) {
    switch_on();
  }
  if (dashboard_) {
    dashboard_->cycle();
  }
  if (robot_api_) {
    robot_api_->cycle();
  }
  if (interpreter_) {
    interpreter_->cycle();
  }
  observers_.remove_if([](const Observer & observer) { return observer(); });
  state_.actual_execution_time = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void Controller::run_robot_cycle()
{
  check_watchdog();
  runner_->cycle();
  handle_script_requests();
  arm_->step(state_);
  joint_sensors_.step(state_);
  joint_history_.record(state_.measured.position);
  if (const auto fault = arm_->take_fault()) {
    safety_->trigger_protective_stop(*fault);
  }
  world_->step(state_);
  check_collisions();
  apply_safety_actions(safety_->step(state_));
  log_safety_events();
  if (pendant_->take_shutdown_request()) {
    switch_off();
  }
}

void Controller::check_collisions()
{
  if (!options_.detect_collisions) {
    return;
  }
  const auto collision = collisions_.check(*world_, state_);
  if (collision && state_.robot_mode == RobotMode::running && allows_motion(state_.safety_mode)) {
    safety_->trigger_protective_stop(collision->description, collision->code);
  }
}

void Controller::check_watchdog()
{
  const auto action = watchdog_.expired(state_.timestamp);
  if (!action) {
    return;
  }
  log_.error("program", "RTDE watchdog: no data package with the watched variable was received in time");
  if (*action == Watchdog::Action::stop) {
    runner_->stop("RTDE watchdog");
  } else if (*action == Watchdog::Action::pause) {
    runner_->pause();
  }
}

void Controller::handle_script_requests()
{
  const ScriptRequestFlags requests = std::exchange(script_requests_, {});
  if (requests.protective_stop) {
    safety_->trigger_protective_stop(requests.stop_reason, *requests.protective_stop);
  }
  if (requests.power_down) {
    pendant_->power_off();
  }
}

void Controller::apply_safety_actions(const SafetyActions & actions)
{
  if (actions.stop_program) {
    runner_->stop("stopped by the safety system");
  }
  if (actions.pause_program) {
    runner_->pause();
  }
  if (actions.stop_arm) {
    arm_->stop_all(*actions.stop_arm);
  }
  if (actions.resume_program) {
    runner_->resume();
  }
}

void Controller::log_safety_events()
{
  while (const auto event = safety_->take_event()) {
    LogEntry entry;
    entry.level = log_level(event->level);
    entry.source = "safety";
    entry.text = event->message;
    if (event->entered_safety_mode) {
      // No client of the message sees an older robot state.
      publish_robot_state();
      entry.kind = LogKind::safety_mode;
      entry.safety_mode = static_cast<std::uint8_t>(event->safety_mode);
    } else if (event->code) {
      entry.kind = LogKind::error_code;
      entry.code = *event->code;
    }
    log_.add(std::move(entry));
    if (event->level == SafetyEvent::Level::error) {
      pendant_->show_safety_popup(event->message);
    }
  }
}

void Controller::publish_state()
{
  trace_.record_cycle(state_);
  rtde_.publish();
  const auto cycles = static_cast<std::uint64_t>(std::lround(robot_state_period / version_.cycle_time()));
  if (state_.cycle % cycles == 0) {
    publish_robot_state();
    publish_global_variables();
  }
  if (realtime_.has_clients() || realtime_read_only_.has_clients()) {
    broadcast(realtime_, realtime_read_only_, realtime_packet_.encode(state_));
  }
}

void Controller::publish_robot_state()
{
  if (primary_.has_clients() || secondary_.has_clients() || primary_read_only_.has_clients() ||
      secondary_read_only_.has_clients()) {
    const std::string message = primary::robot_state_message(model_, version_, state_);
    broadcast(primary_, primary_read_only_, message);
    broadcast(secondary_, secondary_read_only_, message);
  }
}

void Controller::publish_global_variables()
{
  const urscript::Machine * machine = runner_->machine();
  if (machine != nullptr && (primary_.has_clients() || primary_read_only_.has_clients())) {
    broadcast(primary_, primary_read_only_, global_variables_.changes(*machine, state_.timestamp));
  }
}

std::string Controller::primary_greeting() const
{
  std::string messages = primary::version_message(version_);
  if (runner_->machine() != nullptr) {
    messages += global_variables_.all(*runner_->machine(), state_.timestamp);
  }
  return messages;
}

void Controller::report(const LogEntry & entry)
{
  if (entry.kind == LogKind::program_started) {
    global_variables_.begin_program();
  } else if (entry.kind == LogKind::program_ended) {
    publish_global_variables();
  }
  if (client_log_ && entry.source != "rtde") {  // what RTDE clients do is in the client log already
    client_log_->add_event(fmt::format("{}: {}", entry.source, entry.text));
  }
  if (const std::string message = primary::robot_message_for(entry); !message.empty()) {
    broadcast(primary_, primary_read_only_, message, primary::robot_message_name(entry));
  }
}

void Controller::broadcast(primary::ClientInterfaceServer & server,
                           primary::ClientInterfaceServer & read_only, std::string_view message,
                           std::string_view name)
{
  server.broadcast(message, name);
  read_only.broadcast(message, name);
}

void Controller::handle_data_package(std::span<const rtde::InputField * const> fields)
{
  for (const rtde::InputField * field : fields) {
    watchdog_.feed(field->name, state_.timestamp);
    if (field->name == "input_int_register_0") {
      trace_.record_command(state_, fields.size() > 1);
    }
  }
}

}  // namespace ur_simulator
