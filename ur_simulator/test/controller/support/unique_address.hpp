#pragma once

#include <unistd.h>

#include <atomic>
#include <string>

namespace ur_simulator::testing {

/// Returns a loopback address that no other test uses at the same time, derived from the process id and a
/// counter.
inline std::string unique_address()
{
  static std::atomic<unsigned> counter{0};
  const unsigned process = static_cast<unsigned>(getpid());
  const unsigned number = ++counter;
  // 127.64.0.0 and above: not 127.0.0.1 and other addresses that are typically selected by hand.
  return "127." + std::to_string(64 + number % 128) + "." + std::to_string((process >> 8) % 256) + "." +
         std::to_string(1 + process % 254);
}

}  // namespace ur_simulator::testing
