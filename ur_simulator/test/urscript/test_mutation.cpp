#include <random>

#include "support/script_runner.hpp"
#include "urscript/script_reader.hpp"

namespace ur_simulator::urscript {
namespace {

constexpr const char * seed_program = R"(def seed():
  global q = [0, 0.5, -1, 1e-3, 4, 5]
  p = p[0.1, 0.2, 0.3, 0, 3.14, 0]
  m = [[1, 2], [3, 4]]
  s = struct(x = 1, y = [1, 2])
  text = "a" + 'b'
  def f(a, b = 2):
    local c = a * b / 3 % 4
    if c > 1 and not (b == 2) or a != c xor True:
      return -c
    elif c <= 0:
      return f(a - 1, b = 3)
    end
    return m[0, 1] + p[2] + q[3]
  end
  thread t(n):
    while n > 0:
      n = n - 1
      enter_critical
      q[0] = n
      exit_critical
      sync()
    end
  end
  h = run t(3)
  s.y[1] = f(1)
  q.append(7)
  l = [p, p[0, 0, 0, 0, 0, 0]]
  l[1][0] = sin(1) + norm([1, 2]) + str_len(to_str(q))
  while True:
    textmsg("x: ", s)
    sleep(0.01)
    if h != 0:
      break
    end
    continue
  end
  join h
  kill h
end
)";

std::string mutate(const std::string & text, std::mt19937 & random)
{
  static const std::vector<std::string> pieces{"end",      "def f():",
                                               "(",        ")",
                                               "[",        "]",
                                               "p[",       ",",
                                               "=",        "==",
                                               "0",        "-",
                                               "1e999",    "while True:",
                                               "run t(1)", "kill 1",
                                               "join 1",   "global ",
                                               "local ",   "\"",
                                               "#",        "\n",
                                               "$",        ".",
                                               "return",   "break",
                                               "halt",     "q",
                                               "m[0",      "enter_critical",
                                               ":",        "sync()",
                                               "if ",      "99999999999999999999",
                                               "\xff",     std::string(1, '\0'),
                                               "struct(",  "x",
                                               "and",      "not "};
  std::string result = text;
  const int changes = 1 + static_cast<int>(random() % 2);
  for (int i = 0; i < changes; ++i) {
    const std::size_t at = random() % (result.size() + 1);
    const std::size_t length = std::min<std::size_t>(random() % 12, result.size() - at);
    switch (random() % 3) {
      case 0:
        result.erase(at, length);
        break;
      case 1:
        result.insert(at, pieces[random() % pieces.size()]);
        break;
      default:
        result.replace(at, length, result.substr(random() % (result.size() + 1), 8));
        break;
    }
  }
  return result;
}

TEST(MutationTest, TheUnchangedProgramRuns)
{
  ScriptRunner runner(seed_program);
  EXPECT_EQ(runner.finish(), MachineStatus::finished) << runner.machine->error().message;
}

// Every text must be rejected or run within its limits, without a crash.
TEST(MutationTest, NoMutationCrashesTheCompilerOrTheMachine)
{
  std::mt19937 random(20240607);
  const auto library = standard_library();
  MachineOptions options;
  options.infinite_loop_after = 0.02;
  int compiled = 0;
  int rejected = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = mutate(seed_program, random);
    const auto program = compile(text, *library);
    if (!program) {
      ++rejected;
      EXPECT_FALSE(program.error().message.empty());
      EXPECT_GE(program.error().line, 1);
      continue;
    }
    ++compiled;
    RecordingHost host;
    Machine machine(*program, library, host, options);
    for (int cycle = 0; cycle < 40 && machine.cycle() == MachineStatus::running; ++cycle) {
      ASSERT_LE(machine.instructions(), 3 * options.instructions_per_cycle) << text;
    }
  }
  EXPECT_GT(compiled, 200);
  EXPECT_GT(rejected, 400);
}

TEST(MutationTest, NoInputCrashesTheReader)
{
  std::mt19937 random(7);
  ScriptReader reader(2000);
  std::size_t programs = 0;
  for (int i = 0; i < 2000; ++i) {
    reader.feed(mutate("def a():\n if x:\n \"s\" # c\n end\nend\nmove(1)\n", random));
    while (const auto program = reader.next()) {
      EXPECT_FALSE(program->empty());
      ++programs;
    }
    ASSERT_LE(reader.pending(), 2200U);
    if (i % 10 == 9) {
      reader.reset();  // as a new connection does
    }
  }
  EXPECT_GT(programs, 100U);
}

}  // namespace
}  // namespace ur_simulator::urscript
