#include "process/process.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <rcl_cxx/error.hpp>
#include <rcl_cxx/executor.hpp>
#include <rcl_cxx/node.hpp>
#include <string>
#include <thread>
#include <vector>

#include "process/duplicate_check.hpp"
#include "process/fastdds_profile.hpp"

namespace ur_ros_rtde {
namespace {
/// Time to discover an older process with a node of the same name on an idle machine.
constexpr std::chrono::milliseconds discovery_time{300};

void close_servers(const Servers & servers)
{
  std::vector<std::string> left;
  for (auto server = servers.rbegin(); server != servers.rend(); ++server) {
    for (std::string & name : (*server)->close()) {
      left.push_back(std::move(name));
    }
  }
  if (left.empty()) {
    return;
  }
  for (const std::string & name : left) {
    RCL_CXX_FATAL(servers.front()->node().get_logger(), "goal {} did not end, the process exits without it",
                  name);
  }
  // The thread cannot be joined, and objects that it uses must not be destroyed. The watchdog of the control
  // program stops the arm.
  std::_Exit(1);
}

/// Sets `refused` and shuts down if another process has a node with one of these names.
std::vector<std::unique_ptr<DuplicateCheck>> start_duplicate_checks(
    const rcl_cxx::Context::SharedPtr & context, const Servers & servers, std::atomic<bool> & refused)
{
  std::vector<std::unique_ptr<DuplicateCheck>> checks;
  for (const auto & server : servers) {
    rcl_cxx::Node & node = server->node();
    checks.push_back(std::make_unique<DuplicateCheck>(node, [&node, &context, &refused](const auto & why) {
      if (!refused.exchange(true)) {
        RCL_CXX_FATAL(node.get_logger(), "{}", why);
        context->shutdown(why);
      }
    }));
  }
  return checks;
}

void serve(const rcl_cxx::Context::SharedPtr & context, const Servers & servers, std::atomic<bool> & refused)
{
  const auto checks = start_duplicate_checks(context, servers, refused);
  const auto callback = context->add_pre_shutdown_callback([&servers] { close_servers(servers); });
  {
    std::vector<std::unique_ptr<rcl_cxx::Executor>> executors;
    std::vector<std::jthread> threads;
    for (const auto & server : servers) {
      // One executor per node, so that nodes do not delay each other.
      rcl_cxx::Executor & executor = *executors.emplace_back(std::make_unique<rcl_cxx::Executor>(context));
      executor.add_node(server->node());
      threads.emplace_back([&executor] { executor.spin(); });
    }
    try {
      // Before clients can discover the actions of a node that must not start.
      if (!context->wait_for_shutdown_begin(discovery_time)) {
        for (const auto & server : servers) {
          server->start();
        }
      }
    } catch (...) {
      context->shutdown("a node could not start");
      throw;
    }
  }
  context->remove_shutdown_callback(callback);
}
}  // namespace

int run_process(int argc, char ** argv, const MakeServers & make)
{
  constexpr int wrong_arguments = 2;
  rcl_cxx::Context::SharedPtr context;
  std::atomic<bool> refused{false};
  try {
    use_fastdds_profile();
    context = std::make_shared<rcl_cxx::Context>(argc, argv);
    Servers servers = make(context);
    report_fastdds_profile(servers.front()->node().get_logger());
    serve(context, servers, refused);
    while (!servers.empty()) {
      servers.pop_back();
    }
    return refused ? wrong_arguments : 0;
  } catch (const std::exception & error) {
    if (context && !context->ok()) {
      // The process was stopped during its start, so the start failed.
      return refused ? wrong_arguments : 0;
    }
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return dynamic_cast<const rcl_cxx::Error *>(&error) != nullptr ? wrong_arguments : 1;
  }
}

}  // namespace ur_ros_rtde
