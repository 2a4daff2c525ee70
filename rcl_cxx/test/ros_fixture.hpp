#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rcl_cxx/rcl_cxx.hpp"

/// The longest wait of a test. Discovery takes up to 3 s, more on a busy machine.
constexpr std::chrono::seconds kLimit{10};

/// Waits for a condition that another thread makes true.
inline bool eventually(const std::function<bool()> & condition, std::chrono::nanoseconds limit = kLimit)
{
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

inline std::shared_ptr<rcl_cxx::Context> make_context(std::vector<std::string> arguments = {})
{
  arguments.insert(arguments.begin(), "test");
  rcl_cxx::InitOptions options;
  options.shutdown_on_signal = false;
  return std::make_shared<rcl_cxx::Context>(arguments, options);
}

/// An executor that spins in the test's thread.
class InThread : public ::testing::Test {
 protected:
  InThread() { executor.add_node(node); }

  std::shared_ptr<rcl_cxx::Context> context = make_context();
  rcl_cxx::Node node{context, "node"};
  rcl_cxx::Executor executor{context};
};

/// A node whose executor spins in a thread.
class Spinning : public ::testing::Test {
 protected:
  Spinning()
  {
    executor->add_node(node);
    thread = std::thread([this] { executor->spin(); });
  }

  ~Spinning() override
  {
    context->shutdown("end of the test");
    thread.join();
  }

  std::shared_ptr<rcl_cxx::Context> context = make_context();
  std::shared_ptr<rcl_cxx::Node> node = std::make_shared<rcl_cxx::Node>(context, "node", "/test");
  std::unique_ptr<rcl_cxx::Executor> executor = std::make_unique<rcl_cxx::Executor>(context);
  std::thread thread;
};
