#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "urscript/library.hpp"
#include "urscript/machine.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

/// Records the messages and popups of a program.
class RecordingHost : public Host {
 public:
  void text_message(const std::string & text) override { messages.push_back(text); }
  void show_popup(const Popup & popup) override
  {
    popups.push_back(popup);
    open = true;
  }
  bool popup_open() const override { return open; }

  std::vector<std::string> messages;
  std::vector<Popup> popups;
  bool open = false;
};

inline std::shared_ptr<Library> standard_library()
{
  auto library = std::make_shared<Library>();
  add_standard_builtins(*library);
  return library;
}

/// Compiles a program and runs it cycle by cycle.
class ScriptRunner {
 public:
  explicit ScriptRunner(const std::string & text, std::shared_ptr<const Library> library = standard_library(),
                        const MachineOptions & options = {})
  {
    auto program = compile(text, *library);
    if (!program) {
      ADD_FAILURE() << program.error().text();
      program = compile("halt", *library);
    }
    machine = std::make_unique<Machine>(*program, library, host, options);
  }

  /// Runs until the program ends, at most `limit` cycles.
  MachineStatus finish(int limit = 1000)
  {
    cycles = 0;
    while (machine->status() == MachineStatus::running && cycles < limit) {
      machine->cycle();
      ++cycles;
    }
    return machine->status();
  }

  /// A global variable as text; "" when it has no value.
  std::string global(const std::string & name) const
  {
    const Value * value = machine->global(name);
    return value == nullptr ? "" : value->text();
  }

  RecordingHost host;
  std::unique_ptr<Machine> machine;
  int cycles = 0;
};

/// The text of the value of an expression, or "error: …".
inline std::string evaluate(const std::string & expression)
{
  ScriptRunner runner("def evaluate():\n  result = " + expression + "\nend\n");
  if (runner.finish() == MachineStatus::failed) {
    return "error: " + runner.machine->error().message;
  }
  return runner.global("result");
}

inline CompileError compile_error(const std::string & text)
{
  const auto program = compile(text, *standard_library());
  EXPECT_FALSE(program.has_value()) << text;
  return program ? CompileError{} : program.error();
}

}  // namespace ur_simulator::urscript
