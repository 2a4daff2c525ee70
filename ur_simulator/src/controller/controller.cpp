#include "controller/controller.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <stdexcept>
#include <utility>

#include "controller/http_post.hpp"
#include "controller/options.hpp"
#include "controller/rtde_value.hpp"
#include "controller/tcp_script_socket.hpp"
#include "net/text_request.hpp"
#include "primary/messages.hpp"
#include "script_api/function_versions.hpp"
#include "script_api/script_socket.hpp"

namespace ur_simulator {
namespace {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;

// If the host is late, up to this many cycles are executed without serving the connections. Further cycles
// are skipped: the simulated time falls behind.
constexpr int max_consecutive_cycles = 10;

void try_realtime_priority()
{
  sched_param parameters{};
  parameters.sched_priority = 80;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace

// ---- construction

Controller::Controller(const SimulatorOptions & options)
    : model_(select_model(options)),
      version_(select_version(options, model_)),
      options_(options),
      period_(cycle_period(options, version_)),
      initial_joints_(initial_joint_positions(options, model_)),
      arm_(std::in_place, model_, version_.cycle_time(), initial_joints_),
      joint_sensors_(model_, options.seed),
      world_(create_world(options, model_)),
      safety_(std::in_place, model_, version_.cycle_time(), SafetyLimits{}, safety_times(options)),
      collisions_(model_),
      runner_(std::in_place, program_context()),
      pendant_(std::in_place, model_, pendant_options(options, version_), state_, *safety_, *runner_, log_),
      global_variables_(version_),
      primary_(
          io_, options.address, options.ports.primary, *pendant_, [this] { return primary_greeting(); },
          primary::ScriptAccess::full),
      secondary_(
          io_, options.address, options.ports.secondary, *pendant_,
          [this] { return primary::version_message(version_); }, primary::ScriptAccess::full),
      realtime_(io_, options.address, options.ports.realtime, *pendant_, nullptr,
                primary::ScriptAccess::full),
      primary_read_only_(
          io_, options.address, options.ports.primary_read_only, *pendant_,
          [this] { return primary_greeting(); }, primary::ScriptAccess::read_only),
      secondary_read_only_(
          io_, options.address, options.ports.secondary_read_only, *pendant_,
          [this] { return primary::version_message(version_); }, primary::ScriptAccess::read_only),
      realtime_read_only_(io_, options.address, options.ports.realtime_read_only, *pendant_, nullptr,
                          primary::ScriptAccess::read_only),
      interpreter_(open_interpreter_server()),
      realtime_packet_(version_),
      rtde_(io_, options.address, options.ports.rtde, state_, version_, log_),
      dashboard_(open_dashboard_server()),
      robot_api_(open_robot_api()),
      robotiq_(open_robotiq_server()),
      modbus_(open_modbus_server()),
      control_port_context_(control_port_context()),
      control_port_(io_, options.address, options.ports.control,
                    [this](const nlohmann::json & request) { return control(request); }),
      event_timeline_(load_world_file())
{
  rtde_.set_data_package_handler(
      [this](std::span<const rtde::InputField * const> fields) { handle_data_package(fields); });
  pendant_->set_program_request(
      [this](const ProgramHost & host, auto done) { request_program(host, std::move(done)); });
  log_.add_listener([this](const LogEntry & entry) { report(entry); });
  arm_->teleport(initial_joints_, state_);
  if (options_.start_running) {
    safety_->start_running(state_);
  }
}

RobotAccess Controller::robot_access()
{
  ScriptRequests requests;
  requests.power_down = [this] { script_requests_.power_down = true; };
  requests.protective_stop = [this](const ErrorCode & code, std::string reason) {
    script_requests_.protective_stop = code;
    script_requests_.stop_reason = std::move(reason);
  };
  return {state_,
          *arm_,
          *world_,
          model_,
          watchdog_,
          std::move(requests),
          version_.cycle_time(),
          &joint_history_,
          [this](std::string_view name) { return rtde_value(state_, version_, name); },
          interpreter_mode_,
          version_};
}

std::shared_ptr<const urscript::Library> Controller::script_library()
{
  const auto library =
      with_sockets(*make_robot_library(robot_access()), [this](const std::string & host, std::uint16_t port) {
        return TcpScriptSocket::open(io_, host, port, add_host());
      });
  const auto complete = with_xml_rpc(*library, [this](const HttpAddress & to, std::string body) {
    return post_xml(io_, to, std::move(body), add_host());
  });
  return with_functions_of(version_, *complete);
}

ProgramContext Controller::program_context()
{
  return {state_, *arm_, *world_, watchdog_, log_, script_library(), version_.cycle_time()};
}

control_port::ControlPortContext Controller::control_port_context()
{
  return {state_,      *arm_,          *world_, *safety_,
          collisions_, *pendant_,      log_,    rtde_,
          listeners(), missed_cycles_, trace_,  [this](double duration) { reboot(duration); }};
}

std::map<std::string, Listener *> Controller::listeners()
{
  std::map<std::string, Listener *> result{{"primary", &primary_.listener()},
                                           {"secondary", &secondary_.listener()},
                                           {"realtime", &realtime_.listener()},
                                           {"primary_read_only", &primary_read_only_.listener()},
                                           {"secondary_read_only", &secondary_read_only_.listener()},
                                           {"realtime_read_only", &realtime_read_only_.listener()},
                                           {"rtde", &rtde_.listener()}};
  if (dashboard_) {
    result.emplace("dashboard", &dashboard_->listener());
  }
  if (robot_api_) {
    result.emplace("robot_api", &robot_api_->listener());
  }
  if (robotiq_) {
    result.emplace("robotiq", &robotiq_->listener());
  }
  if (modbus_) {
    result.emplace("modbus", &modbus_->listener());
  }
  if (interpreter_) {
    result.emplace("interpreter", &interpreter_->listener());
  }
  return result;
}

std::unique_ptr<dashboard::Server> Controller::open_dashboard_server()
{
  return version_.is_polyscope_x() ? nullptr
                                   : std::make_unique<dashboard::Server>(io_, options_.address,
                                                                         options_.ports.dashboard, *pendant_);
}

std::unique_ptr<robot_api::Server> Controller::open_robot_api()
{
  return version_ < robot_api::Server::first_version
             ? nullptr
             : std::make_unique<robot_api::Server>(io_, options_.address, options_.ports.robot_api,
                                                   *pendant_);
}

std::unique_ptr<urcap::RobotiqServer> Controller::open_robotiq_server()
{
  RobotiqGripper * gripper = world_->robotiq_gripper();
  return gripper == nullptr ? nullptr
                            : std::make_unique<urcap::RobotiqServer>(io_, options_.address,
                                                                     options_.ports.robotiq, *gripper);
}

std::unique_ptr<modbus::Server> Controller::open_modbus_server()
{
  try {
    return std::make_unique<modbus::Server>(io_, options_.address, options_.ports.modbus, state_, version_);
  } catch (const PortNotPermitted & error) {
    // The default port needs privileges on many hosts, and most clients do without MODBUS.
    log_.warning("modbus", fmt::format("there is no MODBUS server: {}", error.what()));
    return nullptr;
  }
}

std::unique_ptr<primary::InterpreterServer> Controller::open_interpreter_server()
{
  return version_ >= PolyscopeVersion{5, 10, 0, 0}
             ? std::make_unique<primary::InterpreterServer>(io_, options_.address, options_.ports.interpreter,
                                                            *pendant_, *interpreter_mode_)
             : nullptr;
}

EventTimeline Controller::load_world_file()
{
  WorldFile file;
  if (!options_.world_file.empty()) {
    file = read_world_file(options_.world_file);
  }
  for (const WorldFileCommand & object : file.objects) {
    try {
      object.action(control_port_context_);
    } catch (const std::exception & error) {
      throw std::runtime_error(fmt::format("{}: {}", object.origin, error.what()));
    }
  }
  return {std::move(file.events), version_.cycle_time()};
}

Ports Controller::ports() const
{
  Ports ports;
  ports.primary = primary_.listener().port();
  ports.secondary = secondary_.listener().port();
  ports.realtime = realtime_.listener().port();
  ports.primary_read_only = primary_read_only_.listener().port();
  ports.secondary_read_only = secondary_read_only_.listener().port();
  ports.realtime_read_only = realtime_read_only_.listener().port();
  ports.rtde = rtde_.listener().port();
  ports.dashboard = dashboard_ ? dashboard_->listener().port() : std::uint16_t{0};
  ports.robot_api = robot_api_ ? robot_api_->listener().port() : std::uint16_t{0};
  ports.modbus = modbus_ ? modbus_->listener().port() : std::uint16_t{0};
  if (robotiq_) {
    ports.robotiq = robotiq_->listener().port();
  }
  if (interpreter_) {
    ports.interpreter = interpreter_->listener().port();
  }
  ports.control = control_port_.listener().port();
  return ports;
}

nlohmann::json Controller::control(const nlohmann::json & request)
{
  return control_port::execute_request(control_port_context_, request);
}

// ---- client log

void Controller::start_client_log(DiagramWriter & writer, const std::string & robot_name)
{
  client_log_.emplace(writer, state_.timestamp, robot_name);
  for (const auto & [name, listener] : control_port_context_.listeners) {
    std::string kind = (name == "rtde" ? "RTDE" : name) + " client";
    std::ranges::replace(kind, '_', ' ');
    listener->set_client_log(*client_log_, std::move(kind));
  }
  control_port_.listener().set_client_log(*client_log_, "control port client");
}

PeerLog Controller::add_host()
{
  return client_log_ ? client_log_->add_peer("host") : PeerLog();
}

void Controller::request_program(const ProgramHost & host,
                                 std::function<void(const Pendant::ProgramText &)> done)
{
  const PeerLog log = add_host();
  log.to_peer("connects to {}:{}: request_program", host.address, host.port);
  async_request_text(io_, host.address, host.port, "request_program\n",
                     [log, done = std::move(done)](const Pendant::ProgramText & text) {
                       if (text) {
                         log.from_peer("program of {} bytes", text->size());
                       } else {
                         log.note("no program: {}", text.error());
                       }
                       done(text);
                     });
}

// ---- event loop

void Controller::run()
{
  if (options_.realtime_priority) {
    try_realtime_priority();
  }
  next_cycle_ = Clock::now() + period_;
  schedule_next_cycle();
  while (!stopping_) {
    try {
      io_.run();
      return;
    } catch (const std::exception & error) {
      // A programming error: it is logged, and the controller continues.
      log_.error("controller", fmt::format("internal error: {}", error.what()));
      if (timer_.expiry() <= Clock::now()) {
        schedule_next_cycle();
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

void Controller::schedule_next_cycle()
{
  timer_.expires_at(next_cycle_);
  timer_.async_wait([this](const boost::system::error_code & error) {
    if (error || stopping_) {
      return;
    }
    run_due_cycles();
    schedule_next_cycle();
  });
}

void Controller::run_due_cycles()
{
  const Clock::time_point now = Clock::now();
  for (int i = 0; i < max_consecutive_cycles && next_cycle_ <= now; ++i) {
    next_cycle_ += period_;
    run_cycle();
  }
  if (next_cycle_ <= now) {
    const auto missed = (now - next_cycle_) / period_ + 1;
    missed_cycles_ += static_cast<std::uint64_t>(missed);
    next_cycle_ += missed * period_;
  }
}

// ---- switching off and on

void Controller::switch_on()
{
  for (const auto & [name, listener] : control_port_context_.listeners) {
    listener->set_accepting(true);
  }
  switch_on_time_.reset();
  log_.info("controller", "switched on");
}

void Controller::switch_off()
{
  for (const auto & [name, listener] : control_port_context_.listeners) {
    listener->close_connections("the controller switches off");
    listener->set_accepting(false);
  }
  runner_->shut_down();
  switch_on_time_ = std::numeric_limits<double>::infinity();
  log_.info("controller", "switched off");
}

void Controller::reboot(double duration)
{
  for (const auto & [name, listener] : control_port_context_.listeners) {
    listener->for_each_connection([](Connection & connection) { connection.reset(); });
  }
  switch_off();
  const Vector6 joint_positions = state_.actual.position;
  state_ = ControllerState();
  trace_.clear();
  script_requests_ = {};
  // Replaced in place: references to these objects stay valid.
  arm_.emplace(model_, version_.cycle_time(), joint_positions);
  arm_->teleport(joint_positions, state_);
  const SafetyInputs inputs = safety_->inputs();
  safety_.emplace(model_, version_.cycle_time(), SafetyLimits{}, safety_times(options_), inputs);
  safety_->step(state_);
  pendant_->reboot();
  switch_on_time_ = duration;
}

}  // namespace ur_simulator
