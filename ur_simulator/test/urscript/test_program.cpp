#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

TEST(MemoryTest, IsLimited)
{
  const std::string many_strings =
      "def test():\n l = []\n text = \"x\"\n while str_len(text) < 8192:\n text = text + text\n end\n"
      " while True:\n l.append(text + \"y\")\n sync()\n end\nend";
  const std::string recursion =
      "def test():\n def f(n):\n list = make_list(9000, n)\n f(n + 1)\n return list\n end\n f(0)\nend";
  for (const std::string & program : {many_strings, recursion}) {
    MachineOptions options;
    options.memory = 4U << 20U;
    ScriptRunner runner(program, standard_library(), options);
    EXPECT_EQ(runner.finish(10000), MachineStatus::failed);
    EXPECT_EQ(runner.machine->error().message,
              "out of memory: the values of the program need more than 4 MiB");
  }
}

TEST(MemoryTest, SharedValuesCountOnce)
{
  ScriptRunner runner(
      "def test():\n l = make_list(900, make_list(9, \"text\"))\n def f(n):\n mine = l\n if n > 0:\n f(n - "
      "1)\n"
      " end\n sync()\n end\n i = 0\n while i < 100:\n f(200)\n i = i + 1\n end\nend");
  EXPECT_EQ(runner.finish(50000), MachineStatus::finished) << runner.machine->error().message;
}

TEST(NoneTest, IsAValue)
{
  ScriptRunner runner("def test():\n def f():\n return None\n end\n f()\n x = 1\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished) << runner.machine->error().message;
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(TimeTest, IsThatOfTheProgramOrUtc)
{
  ScriptRunner runner(
      "def test():\n a = time(0)\n sleep(1)\n b = time(0)\n passed = b.sec - a.sec + (b.nanosec - a.nanosec) "
      "* 1e-9\n "
      "utc = time(2)\n s = utc.sec\n none = time(1)\nend");
  EXPECT_EQ(runner.finish(10000), MachineStatus::failed);
  EXPECT_NE(runner.machine->error().message.find("mode must be 0 (monotonic) or 2 (UTC)"), std::string::npos);
  EXPECT_NEAR(runner.machine->global("passed")->number().value(), 1.0, 0.01);
  EXPECT_GT(runner.machine->global("s")->number().value(), 1.7e9);
}

TEST(BlockingPopupTest, BlocksTheThreadUntilTheOperatorClosesIt)
{
  ScriptRunner runner("def test():\n popup(\"Ready?\", title=\"Check\", blocking=True)\n x = 1\nend");
  for (int i = 0; i < 10; ++i) {
    runner.machine->cycle();
  }
  ASSERT_EQ(runner.host.popups.size(), 1U);
  EXPECT_EQ(runner.host.popups[0].message, "Ready?");
  EXPECT_EQ(runner.host.popups[0].title, "Check");
  EXPECT_EQ(runner.machine->status(), MachineStatus::running);
  runner.host.open = false;
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

}  // namespace
}  // namespace ur_simulator::urscript
