#pragma once

#include <unistd.h>

#include <atomic>
#include <string>

namespace ur_simulator::testing {

/// A loopback address no other test uses at the same time: from this process's id and a counter.
inline std::string next_address()
{
  static std::atomic<unsigned> counter{0};
  const unsigned process = static_cast<unsigned>(getpid());
  const unsigned number = ++counter;
  // 127.64.0.0/10 and above: away from 127.0.0.1 and from what people choose by hand.
  return "127." + std::to_string(64 + number % 128) + "." + std::to_string((process >> 8) % 256) + "." +
         std::to_string(1 + process % 254);
}

}  // namespace ur_simulator::testing
