#pragma once

#include <chrono>
#include <thread>

#include "node/node_impl.hpp"

namespace rcl_cxx::detail {
/// Checks `condition` every 5 ms. Returns false on timeout and shutdown.
template <typename Condition>
bool wait_for(NodeImpl & node, const Condition & condition, std::chrono::nanoseconds timeout)
{
  const auto start = std::chrono::steady_clock::now();
  while (node.get_context().ok()) {
    if (condition()) {
      return true;
    }
    if (std::chrono::steady_clock::now() - start >= timeout) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace rcl_cxx::detail
