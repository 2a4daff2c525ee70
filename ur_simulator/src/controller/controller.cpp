#include "controller/controller.hpp"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <exception>
#include <limits>
#include <span>
#include <utility>

#include "control_port/commands.hpp"
#include "controller/configuration.hpp"
#include "controller/network_socket.hpp"
#include "net/fetch.hpp"
#include "primary/messages.hpp"
#include "primary/robot_state.hpp"
#include "script_api/script_socket.hpp"

namespace ur_simulator {
namespace {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;

// A late host is caught up with up to this many cycles in a row; beyond, the simulated time falls behind
// instead of the sockets starving.
constexpr int most_cycles_to_catch_up = 10;
constexpr double robot_state_period = 0.1;  // s

LogLevel level_of(SafetyEvent::Level level)
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

Controller::Controller(const SimulatorOptions & options)
    : model_(model_of(options)),
      version_(version_of(options, model_)),
      options_(options),
      period_(period_of(options, version_)),
      initial_joints_(joints_of(options, model_)),
      arm_(std::in_place, model_, version_.cycle_time(), initial_joints_),
      world_(world_of(options, version_.cycle_time())),
      safety_(std::in_place, model_, version_.cycle_time(), SafetyLimits{}, safety_times(options)),
      runner_(std::in_place, program_access()),
      pendant_(std::in_place, model_, pendant_options(options, version_), state_, *safety_, *runner_, log_),
      primary_(io_, options.address, options.ports.primary, *pendant_, primary::version_message(version_)),
      secondary_(io_, options.address, options.ports.secondary, *pendant_,
                 primary::version_message(version_)),
      realtime_(io_, options.address, options.ports.realtime, *pendant_, ""),
      realtime_packet_(version_),
      rtde_(io_, options.address, options.ports.rtde, state_, version_, log_),
      dashboard_(io_, options.address, options.ports.dashboard, *pendant_),
      bench_{state_,
             *arm_,
             *world_,
             *safety_,
             *pendant_,
             log_,
             rtde_,
             {{"primary", &primary_.listener()},
              {"secondary", &secondary_.listener()},
              {"realtime", &realtime_.listener()},
              {"rtde", &rtde_.listener()},
              {"dashboard", &dashboard_.listener()}},
             missed_cycles_,
             trace_,
             [this](double duration) { reboot(duration); }},
      control_(io_, options.address, options.ports.control,
               [this](const nlohmann::json & request) { return control(request); })
{
  rtde_.on_package([this](std::span<const rtde::InputField * const> fields) {
    for (const rtde::InputField * field : fields) {
      watchdog_.fed(field->name, state_.timestamp);
      if (field->name == "input_int_register_0") {
        trace_.command_arrived(state_, fields.size() > 1);
      }
    }
  });
  pendant_->fetch_programs_by([this](const ProgramHost & host, auto done) {
    fetch(io_, host.address, host.port, "request_program\n", std::move(done));
  });
  log_.add_listener([this](const LogEntry & entry) { primary_.broadcast(primary::message_for(entry)); });
  arm_->teleport(initial_joints_, state_);
  if (options_.start_running) {
    safety_->start_running(state_);
  }
}

RobotAccess Controller::access()
{
  ScriptRequests requests;
  requests.power_down = [this] { requests_.power_down = true; };
  requests.protective_stop = [this] { requests_.protective_stop = true; };
  return {state_,         *arm_, *world_, model_, watchdog_, std::move(requests), version_.cycle_time(),
          &joint_history_};
}

std::shared_ptr<const urscript::Library> Controller::library()
{
  return with_sockets(*make_robot_library(access()), [this](const std::string & host, std::uint16_t port) {
    return NetworkSocket::open(io_, host, port);
  });
}

ProgramAccess Controller::program_access()
{
  return {state_, *arm_, watchdog_, log_, library(), version_.cycle_time()};
}

Ports Controller::ports() const
{
  Ports ports;
  ports.primary = primary_.listener().port();
  ports.secondary = secondary_.listener().port();
  ports.realtime = realtime_.listener().port();
  ports.rtde = rtde_.listener().port();
  ports.dashboard = dashboard_.listener().port();
  ports.control = control_.listener().port();
  return ports;
}

nlohmann::json Controller::control(const nlohmann::json & request)
{
  return control_port::handle(bench_, request);
}

// ---- the loop

void Controller::run()
{
  deadline_ = Clock::now() + period_;
  wait_for_next_cycle();
  while (!stopping_) {
    try {
      io_.run();
      return;
    } catch (const std::exception & error) {
      // A defect: said loudly, but it takes no robot down.
      log_.error("controller", fmt::format("internal error: {}", error.what()));
      if (timer_.expiry() <= Clock::now()) {
        wait_for_next_cycle();
      }
    }
  }
}

void Controller::stop()
{
  asio::post(io_, [this] {
    stopping_ = true;
    io_.stop();
  });
}

void Controller::wait_for_next_cycle()
{
  timer_.expires_at(deadline_);
  timer_.async_wait([this](const boost::system::error_code & error) {
    if (error || stopping_) {
      return;
    }
    keep_pace();
    wait_for_next_cycle();
  });
}

void Controller::keep_pace()
{
  const Clock::time_point now = Clock::now();
  for (int i = 0; i < most_cycles_to_catch_up && deadline_ <= now; ++i) {
    deadline_ += period_;
    cycle();
  }
  if (deadline_ <= now) {
    const auto missed = (now - deadline_) / period_ + 1;
    missed_cycles_ += static_cast<std::uint64_t>(missed);
    deadline_ += missed * period_;
  }
}

void Controller::cycle()
{
  const Clock::time_point begin = Clock::now();
  ++state_.cycle;
  state_.timestamp = static_cast<double>(state_.cycle) * version_.cycle_time();
  log_.set_time(state_.timestamp);
  if (boots_at_) {
    if (state_.timestamp >= *boots_at_) {
      power_switch(true);
    }
  } else {
    step_robot();
    publish();
  }
  dashboard_.cycle();
  observers_.remove_if([](const Observer & observer) { return observer(); });
  state_.actual_execution_time = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void Controller::step_robot()
{
  if (const auto action = watchdog_.expired(state_.timestamp)) {
    log_.error("program", "RTDE watchdog: no data package with the watched variable came in time");
    if (*action == Watchdog::Action::stop) {
      runner_->stop("RTDE watchdog");
    } else if (*action == Watchdog::Action::pause) {
      runner_->pause();
    }
  }
  runner_->cycle();
  act_on_requests();
  arm_->step(state_);
  joint_history_.record(state_.actual.position);
  if (const auto fault = arm_->take_fault()) {
    safety_->trip(*fault);
  }
  world_->step(state_);
  obey(safety_->step(state_));
  take_safety_events();
  if (pendant_->shutdown_requested()) {
    pendant_->request_shutdown(false);
    power_switch(false);
  }
}

void Controller::act_on_requests()
{
  const Requests requests = std::exchange(requests_, {});
  if (requests.protective_stop) {
    safety_->trip("the program called protective_stop()");
  }
  if (requests.power_down) {
    pendant_->power_off();
  }
}

void Controller::obey(const SafetyOrders & orders)
{
  if (orders.stop_program) {
    runner_->stop("stopped by the safety system");
  }
  if (orders.pause_program) {
    runner_->pause();
  }
  if (orders.halt) {
    arm_->halt(*orders.halt);
  }
  if (orders.resume_program) {
    runner_->resume();
  }
}

void Controller::take_safety_events()
{
  while (const auto event = safety_->take_event()) {
    LogEntry entry;
    entry.level = level_of(event->level);
    entry.source = "safety";
    entry.text = event->message;
    entry.kind = entry.level == LogLevel::info ? LogKind::text : LogKind::safety;
    log_.add(std::move(entry));
    if (event->level == SafetyEvent::Level::error) {
      pendant_->show_safety_popup(event->message);
    }
  }
}

void Controller::publish()
{
  trace_.cycle_publishing(state_);
  rtde_.publish();
  const auto cycles = static_cast<std::uint64_t>(std::lround(robot_state_period / version_.cycle_time()));
  const bool state_is_due =
      state_.cycle % cycles == 0 && (primary_.has_clients() || secondary_.has_clients());
  if (state_is_due) {
    const std::string message = primary::robot_state_message(model_, state_);
    primary_.broadcast(message);
    secondary_.broadcast(message);
  }
  if (realtime_.has_clients()) {
    realtime_.broadcast(realtime_packet_.encode(state_));
  }
}

// ---- switching off and on

void Controller::power_switch(bool on)
{
  for (const auto & [name, link] : bench_.links) {
    if (!on) {
      link->close_all();
    }
    link->set_accepting(on);
  }
  if (on) {
    boots_at_.reset();
    log_.info("controller", "switched on");
  } else {
    runner_->shut_down();
    boots_at_ = std::numeric_limits<double>::infinity();
    log_.info("controller", "switched off");
  }
}

void Controller::reboot(double duration)
{
  for (const auto & [name, link] : bench_.links) {
    link->for_each([](Connection & connection) { connection.reset(); });
  }
  power_switch(false);
  const Vector6 where = state_.actual.position;
  state_ = ControllerState();
  requests_ = {};
  // In place: everything that refers to these goes on referring to the new ones.
  arm_.emplace(model_, version_.cycle_time(), where);
  arm_->teleport(where, state_);
  safety_.emplace(model_, version_.cycle_time(), SafetyLimits{}, safety_times(options_));
  safety_->step(state_);
  boots_at_ = duration;
}

}  // namespace ur_simulator
