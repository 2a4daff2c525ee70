#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "connection/primary_connection.hpp"
#include "script/program.hpp"
#include "ur_ros_rtde_robot/program/script.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Monitors one script from sending to its end, using the messages of the primary interface and, for a
/// program, the runtime state of the samples. Not thread-safe.
class ScriptMonitor {
 public:
  /// Lines that the script writes with `textmsg` when it begins and when it ends.
  struct Markers {
    std::string begin;
    std::string end;
  };

  ScriptMonitor(PrimaryConnection primary, const StateReceiver & state, Markers markers,
                const ScriptOptions & options);

  /// Called when the controller has begun to execute the script, or will not begin: a stop has not to wait
  /// for it any longer.
  std::function<void()> on_compiled = [] {};
  /// Makes it impossible to send the script. May be called by another thread. A connection that has sent it
  /// stays open: the controller, which may close one that is shut down, tells what becomes of the script.
  void fence() const;
  /// Sends the program and waits until it has ended or has to be stopped; see may_be_running().
  void run(const script::Program & program);
  /// After run(): reads on until on_compiled() was called, or `ends`.
  void read_until_compiled(const std::function<bool()> & ends);
  /// True if the program may still be running on the controller and has to be stopped.
  bool may_be_running() const { return may_be_running_; }
  /// True if another program has replaced this one.
  bool replaced() const { return !replaced_by_.empty(); }
  ScriptReport report() const;

 private:
  using Clock = std::chrono::steady_clock;

  /// Each returns true if the report is complete.
  bool update();
  bool replaced_before_begin();
  bool read_messages(std::chrono::milliseconds wait);
  bool complete_if_failed();
  bool complete_if_ended();
  bool complete_if_it_must_stop();
  /// By ScriptOptions::stop_reason.
  bool complete_if_told(ScriptEnd end);
  bool complete_if_late();
  bool is_paused(const Sample & sample);

  void on_message(const PrimaryMessage & message);
  void on_text(const std::string & text);
  bool complete(ScriptEnd end, ErrorCode code, std::string message);
  bool complete_with_error();
  bool complete_as_stopped();

  PrimaryConnection primary_;
  const StateReceiver & state_;
  const Markers markers_;
  const ScriptOptions & options_;
  const script::Program * program_ = nullptr;
  std::uint32_t link_ = 0;  ///< Sample::link when the program was sent
  std::atomic<bool> is_sent_ = false;
  bool may_be_running_ = false;
  bool has_played_ = false;  ///< a sample has shown the program running
  bool ended_before_begin_ = false;
  bool messages_left_ = false;  ///< read_messages() has not reached the newest message
  Clock::time_point sent_{};
  /// When the controller has started it, executed its first line, and so on.
  std::optional<Clock::time_point> started_, begin_seen_, end_seen_, error_seen_, pause_seen_, stop_seen_;
  std::string replaced_by_;
  PrimaryMessage error_{};
  std::string error_code_;  ///< with its text, of the newest violation or fault since the script began
  ScriptReport report_;
};

}  // namespace ur_ros_rtde
