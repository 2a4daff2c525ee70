#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "urscript/host.hpp"
#include "urscript/library.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

enum class MachineStatus : std::uint8_t { running, finished, failed };

/// A run-time error, as the controller reports it.
struct RunTimeError {
  std::int32_t line = 0;  ///< 1-based, in the program's text
  std::string message;
};

struct MachineOptions {
  double cycle_time = 0.002;  ///< s
  std::uint32_t instructions_per_cycle =
      5000;  ///< of all threads together; what is left goes on in the next cycle
  /// A thread that computes this long without taking physical time (sync, sleep, a motion, …) fails: s of
  /// simulated time.
  double infinite_loop_after = 2.0;
  std::size_t threads = 64;
  std::size_t call_depth = 256;
};

/// Runs one program, one control cycle at a time, on the caller's thread. Threads of the program take turns
/// ("Thread scheduling" in the script manual): in each cycle each runs until it takes physical time or has
/// used its share of the instructions. Nothing throws; an error ends the program.
class Machine {
 public:
  Machine(Program program, std::shared_ptr<const Library> library, Host & host,
          const MachineOptions & options = {});
  /// Stops the program if it still runs.
  ~Machine();
  Machine(const Machine &) = delete;
  Machine & operator=(const Machine &) = delete;

  /// One control cycle. Once it is not `running` it stays as it is.
  MachineStatus cycle();
  /// Ends every thread; what they were doing is abandoned (a motion decelerates). Status becomes finished
  /// unless it failed.
  void stop();

  MachineStatus status() const;
  /// Meaningful when failed.
  const RunTimeError & error() const;
  const Program & program() const;
  std::size_t thread_count() const;
  /// Instructions of the last cycle: how much the program computes.
  std::uint32_t instructions() const;
  /// A global variable's value now, null when there is none (tests, the control port).
  const Value * global(const std::string & name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator::urscript
