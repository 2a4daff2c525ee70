// The queue of interpreter mode, without a program and without sockets.
#include <gtest/gtest.h>

#include <string>

#include "script_api/interpreter_mode.hpp"

namespace ur_simulator {
namespace {

/// Counts the statements that are compiled.
struct CountingExtension : urscript::ProgramExtension {
  tl::expected<std::uint32_t, std::string> add(std::string_view) override { return ++statements; }
  void remove_all() override {}

  std::uint32_t statements = 0;
};

TEST(InterpreterQueueTest, NoCycleInterpretsMoreThanAFewStatements)
{
  CountingExtension extension;
  InterpreterMode mode;
  mode.set_program_running(true);
  mode.begin(1, extension, {.clear_queue_on_enter = false});
  ASSERT_TRUE(mode.cycle());
  constexpr std::uint32_t sent = 2000;
  std::uint32_t answers = 0;
  std::uint32_t before = 0;
  const auto end_cycle = [&] {
    EXPECT_LE(extension.statements - before, 40U);
    EXPECT_EQ(answers, extension.statements);
    before = extension.statements;
    mode.begin_cycle();
  };
  for (std::uint32_t i = 0; i < sent; ++i) {  // all in one control cycle
    mode.receive("movej([0, -1.57, 1.57, -1.57, -1.57, 0], a=0.5, v=0.5)",
                 [&](const std::string &) { ++answers; });
  }
  for (int cycle = 0; cycle < 100; ++cycle) {
    end_cycle();
  }
  EXPECT_EQ(answers, sent) << "and all are interpreted soon";
}

}  // namespace
}  // namespace ur_simulator
