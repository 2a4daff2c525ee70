#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "urscript/library.hpp"

namespace ur_simulator {

/// Interpreter mode: the statements that clients send while a program is in `interpreter_mode()`, and what
/// they are answered (UR, script manual 5.10 and later, "Interpreter Mode"). A server calls the first
/// functions, the program those from begin() on.
class InterpreterMode {
 public:
  using Reply = std::function<void(std::string line)>;
  struct Options {
    bool clear_queue_on_enter = true;
    bool clear_on_end = true;
  };

  /// Handles a line of a client; `reply` is called once, now or later.
  void receive(std::string_view line, Reply reply);
  /// Whether a program is running. When it ends, queued statements are discarded.
  void set_program_running(bool running);
  /// Call once per control cycle: as many statements are interpreted in it as do not delay it.
  void begin_cycle();
  /// Called by the command `abort`.
  void set_abort_handler(std::function<void()> handler) { abort_ = std::move(handler); }

  bool active() const { return extension_ != nullptr; }
  /// The extension is valid until cycle() returns false or cancel(). The numbers of statements begin at 1 in
  /// each program.
  void begin(std::uint64_t program, urscript::ProgramExtension & extension, const Options & options);
  /// Interprets queued statements. Call once per cycle in which no statement is executed. Returns whether the
  /// mode goes on.
  bool cycle();
  /// The function of the next statement, which is now executed.
  std::optional<std::uint32_t> next_function();
  void request_end() { end_requested_ = true; }
  void request_clear() { clear_requested_ = true; }
  /// The interpreter mode was left because its thread has ended.
  void cancel();

 private:
  struct Line {
    std::string text;
    Reply reply;
  };
  struct Statement {
    std::uint32_t id;
    std::uint32_t function;
  };

  std::optional<std::string> handle_command(std::string_view line);
  void accept_statement(const Line & line);
  void interpret_queue();
  void discard_queue(std::string_view reason);
  void clear();

  bool program_running_ = false;
  std::uint64_t program_ = 0;
  urscript::ProgramExtension * extension_ = nullptr;  ///< null: not in interpreter mode
  Options options_;
  std::deque<Line> queue_;            ///< received, not interpreted
  std::deque<Statement> statements_;  ///< interpreted, not executed
  std::size_t queued_bytes_ = 0;
  std::size_t cycle_bytes_ = 0;  ///< interpreted in this control cycle
  bool clearing_ = false;        ///< a statement that clears is interpreted, but not executed
  bool may_interpret_ = false;   ///< the program is not being executed by the caller of begin()
  bool end_requested_ = false;
  bool clear_requested_ = false;
  std::uint32_t last_id_ = 0;
  std::uint32_t last_executed_ = 0;
  std::uint32_t last_cleared_ = 0;
  std::function<void()> abort_;
};

}  // namespace ur_simulator
