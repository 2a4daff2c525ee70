#include "process/process.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <rcl_cxx/error.hpp>
#include <rcl_cxx/executor.hpp>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

#include "process/arguments.hpp"
#include "process/duplicate_check.hpp"
#include "process/fastdds_profile.hpp"
#include "process/host_name_lock.hpp"
#include "process/parameter_names.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = std::chrono::steady_clock;

/// Time to discover an older process on another host with a node of the same name, on an idle network.
constexpr std::chrono::milliseconds discovery_time{200};
/// The same on this host if there is one, however busy the host is.
constexpr std::chrono::seconds local_discovery_time{3};
constexpr std::chrono::milliseconds discovery_check_period{10};

void close_servers(const Servers & servers)
{
  for (const auto & server : servers) {
    server->end_goals();
  }
  std::vector<std::string> left;
  for (auto server = servers.rbegin(); server != servers.rend(); ++server) {
    for (std::string & name : (*server)->close()) {
      left.push_back(std::move(name));
    }
  }
  exit_without(left, servers.front()->node());
}

/// Destroys them in reverse, also after an exception: a server may call those before it.
struct ServersInReverse {
  Servers servers;
  ~ServersInReverse()
  {
    while (!servers.empty()) {
      servers.pop_back();
    }
  }
};

using DuplicateChecks = std::vector<std::unique_ptr<DuplicateCheck>>;

void reject_start(const rcl_cxx::Node & node, const std::string & why, std::atomic<bool> & rejected)
{
  if (!rejected.exchange(true)) {
    RCL_CXX_FATAL(node.get_logger(), "{}", why);
    node.get_context()->shutdown(why);
  }
}

DuplicateChecks start_duplicate_checks(const Servers & servers, std::atomic<bool> & rejected)
{
  DuplicateChecks checks;
  for (const auto & server : servers) {
    rcl_cxx::Node & node = server->node();
    checks.push_back(std::make_unique<DuplicateCheck>(
        node, [&node, &rejected](const std::string & why) { reject_start(node, why, rejected); }));
  }
  return checks;
}

/// True if another process of this host has a node with one of these names, possibly in another network of
/// ROS.
bool reserve_names(const Servers & servers, std::vector<std::unique_ptr<HostNameLock>> & names)
{
  const char * domain = std::getenv("ROS_DOMAIN_ID");
  bool taken = false;
  for (const auto & server : servers) {
    names.push_back(std::make_unique<HostNameLock>(fmt::format(
        "ur_ros_rtde/{}{}", domain != nullptr ? domain : "0", server->node().get_fully_qualified_name())));
    taken = taken || names.back()->taken_by_other();
  }
  return taken;
}

/// Starts the servers at `when` if no older process has been found until then. Otherwise returns the reason.
std::optional<std::string> start_if_unique(const rcl_cxx::Context & context, const Servers & servers,
                                           const DuplicateChecks & checks, Clock::time_point when)
{
  do {
    for (const auto & check : checks) {
      if (auto why = check->find_older()) {
        return why;
      }
    }
    if (context.wait_for_shutdown_begin(discovery_check_period)) {
      return std::nullopt;
    }
  } while (Clock::now() < when);
  for (const auto & server : servers) {
    server->start();
  }
  return std::nullopt;
}

void spin_if_unique(const rcl_cxx::Context::SharedPtr & context,
                    const std::function<void(rcl_cxx::Executor &)> & add_callbacks,
                    const std::shared_future<std::optional<std::string>> & duplicate)
{
  if (!duplicate.get()) {
    rcl_cxx::Executor executor(context);
    add_callbacks(executor);
    executor.spin();
  }
}

/// Creates the actions while older processes are being discovered and the robot is being connected, so that
/// clients discover them early. Servers on demand, and goals, have to wait until the node has its executors:
/// a process that must not start answers nothing. Returns the reason not to start, or nothing after the
/// shutdown.
std::optional<std::string> run_servers(const rcl_cxx::Context::SharedPtr & context, const Servers & servers,
                                       const DuplicateChecks & checks, Clock::time_point start,
                                       bool & has_failed)
{
  const auto duplicate = std::async(std::launch::async, [&] {
                           return start_if_unique(*context, servers, checks, start);
                         }).share();
  std::vector<std::future<void>> running;
  try {
    const auto spin = [&](const std::function<void(rcl_cxx::Executor &)> & add_callbacks) {
      running.push_back(std::async(std::launch::async, spin_if_unique, std::cref(context), add_callbacks,
                                   std::cref(duplicate)));
    };
    for (const auto & server : servers) {
      // One executor per node, so that nodes do not delay each other; and one per group of callbacks that
      // must not wait for those of the node.
      spin([&server](rcl_cxx::Executor & executor) { executor.add_node(server->node()); });
      for (const auto * group : server->groups()) {
        spin([group](rcl_cxx::Executor & executor) { executor.add_callback_group(*group); });
      }
    }
    for (const auto & server : servers) {
      server->create_actions();
    }
    for (auto & server : running) {
      server.get();
    }
    return duplicate.get();
  } catch (...) {
    has_failed = context->ok();  // otherwise the process was stopped during its start
    context->shutdown("a node could not start");
    throw;
  }
}

void serve(const rcl_cxx::Context::SharedPtr & context, const Servers & servers, std::atomic<bool> & rejected,
           bool & has_failed)
{
  const auto begin = Clock::now();
  std::vector<std::unique_ptr<HostNameLock>> names;
  const bool taken = reserve_names(servers, names);
  const auto checks = start_duplicate_checks(servers, rejected);
  for (const auto & server : servers) {
    server->load_plugins();
  }
  check_parameter_names(servers);
  const auto callback = context->add_pre_shutdown_callback([&servers] { close_servers(servers); });
  const auto start = begin + (taken ? Clock::duration(local_discovery_time) : discovery_time);
  if (const auto why = run_servers(context, servers, checks, start, has_failed)) {
    reject_start(servers.front()->node(), *why, rejected);
  }
  context->remove_shutdown_callback(callback);
}
}  // namespace

int run_process(int argc, char ** argv, const MakeServers & make)
{
  constexpr int wrong_arguments = 2;
  rcl_cxx::Context::SharedPtr context;
  std::atomic<bool> rejected{false};
  bool has_failed = false;
  try {
    use_fastdds_profile();
    context = std::make_shared<rcl_cxx::Context>(argc, argv);
    const auto help = help_asked_for(context->non_ros_arguments());
    if (!help || !help->empty()) {
      std::fprintf(help ? stdout : stderr, "%s\n", help ? help->c_str() : help.error().c_str());
      return help ? 0 : wrong_arguments;
    }
    std::signal(SIGPIPE, SIG_IGN);  // nobody reads the log: not a reason to leave the arm
    ServersInReverse made{make(context)};
    report_fastdds_profile(made.servers.front()->node().get_logger());
    serve(context, made.servers, rejected, has_failed);
    return rejected ? wrong_arguments : 0;
  } catch (const std::exception & error) {
    if (context && !context->ok() && !has_failed) {
      // The process was stopped during its start, so the start failed.
      return rejected ? wrong_arguments : 0;
    }
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return dynamic_cast<const rcl_cxx::Error *>(&error) != nullptr ? wrong_arguments : 1;
  }
}

}  // namespace ur_ros_rtde
