#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "connection/primary_link.hpp"
#include "script/program.hpp"
#include "ur_ros_rtde_robot/program/script.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Follows one script from its sending to its end: by what the primary interface says of it, and for a
/// program by the runtime state of the samples. Used by one thread.
class ScriptWatch {
 public:
  struct Marks {
    std::string begin;
    std::string end;
  };

  ScriptWatch(PrimaryLink primary, const StateReceiver & state, Marks marks, const ScriptOptions & options);

  /// Sends the program and waits until it has ended or has to be ended: running() tells which.
  void follow(const script::Program & program);
  /// It may still run: it was begun, or may have been, and has not ended by itself.
  bool running() const { return running_; }
  /// Another program took its place.
  bool replaced() const { return !replaced_by_.empty(); }
  ScriptReport report() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool look();
  bool listen();
  void hear(const PrimaryMessage & message);
  bool has_to_end();
  bool has_failed();
  bool has_ended();
  void end(ScriptEnd how, ErrorCode code, std::string message);
  void end_by_error();

  PrimaryLink primary_;
  const StateReceiver & state_;
  const Marks marks_;
  const ScriptOptions & options_;
  const script::Program * program_ = nullptr;
  bool running_ = false;
  bool ended_ = false;
  bool played_ = false;  ///< the samples have shown it running
  Clock::time_point sent_{};
  std::optional<Clock::time_point> began_, said_end_, failed_, seen_stopped_;
  std::string replaced_by_;
  PrimaryMessage failure_{};
  ScriptReport report_;
};

}  // namespace ur_ros_rtde
