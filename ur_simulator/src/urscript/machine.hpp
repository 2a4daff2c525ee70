#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "urscript/host.hpp"
#include "urscript/library.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

enum class MachineStatus : std::uint8_t { running, finished, failed };

/// A run-time error of a program.
struct RunTimeError {
  std::int32_t line = 0;  ///< 1-based, in the text of the program
  std::string message;
};

struct MachineOptions {
  double cycle_time = 0.002;  ///< s
  /// s, of time(), since the controller started. Empty: the time that this program has run.
  std::function<double()> clock{};
  std::uint32_t instructions_per_cycle =
      5000;  ///< of all threads together; the rest continues in the next cycle
  /// s of simulated time. A thread that computes longer without taking physical time (sync, sleep, a motion,
  /// …) fails.
  double infinite_loop_after = 2.0;
  std::size_t threads = 64;
  std::size_t call_depth = 256;
  std::size_t memory = 32U << 20U;  ///< bytes of all values of the program
};

/// Runs one program, one control cycle at a time, on the caller's thread. In each cycle every thread of the
/// program runs until it takes physical time or has used its share of the instructions (script manual,
/// "Thread scheduling"). Nothing throws; an error ends the program.
class Machine {
 public:
  Machine(Program program, std::shared_ptr<const Library> library, Host & host,
          const MachineOptions & options = {});
  /// Stops the program if it is running.
  ~Machine();
  Machine(const Machine &) = delete;
  Machine & operator=(const Machine &) = delete;

  /// Runs one control cycle; no effect once the status is not `running`.
  MachineStatus cycle();
  /// Ends all threads and cancels their operations (a motion decelerates). The status becomes `finished`
  /// unless it is `failed`.
  void stop();

  MachineStatus status() const;
  /// Valid if the status is `failed`.
  const RunTimeError & error() const;
  const Program & program() const;
  std::size_t thread_count() const;
  /// Number of instructions executed in the last cycle.
  std::uint32_t instructions() const;
  /// The names of the global variables, in the order of their first appearance in the program.
  const std::vector<std::string> & global_names() const;
  /// The current value of a global variable; null if it has none.
  const Value * global(const std::string & name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator::urscript
