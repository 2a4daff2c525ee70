#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

/// A builtin that takes physical time until the test ends it, like a motion.
struct Motion {
  bool done = false;
  int started = 0;
  int abandoned = 0;
};

class MotionOperation : public PendingCall {
 public:
  explicit MotionOperation(Motion & motion) : motion_(motion) {}
  tl::expected<std::optional<Value>, std::string> poll(CallContext &) override
  {
    return motion_.done ? std::optional<Value>(Value()) : std::nullopt;
  }
  void cancel() override { ++motion_.abandoned; }

 private:
  Motion & motion_;
};

std::shared_ptr<Library> library_with(Motion & motion)
{
  auto library = standard_library();
  library->add({"move", {}, 0, [&motion](CallContext &, Arguments) -> Outcome {
                  ++motion.started;
                  return std::make_unique<MotionOperation>(motion);
                }});
  return library;
}

TEST(ThreadTest, AlternateAtEachSync)
{
  ScriptRunner runner(R"(def test():
    global log = ""
    thread ping():
      while True:
        log = log + "a"
        sync()
      end
    end
    handle = run ping()
    i = 0
    while i < 3:
      log = log + "b"
      i = i + 1
      sync()
    end
    kill handle
    sync()
    log = log + "!"
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("log"), "bababa!");
}

TEST(ThreadTest, StartOnlyAfterTheHandleIsAssigned)
{
  ScriptRunner runner(R"(def test():
    global handle = 0
    global seen = -1
    thread child():
      seen = handle
      handle = 0
    end
    handle = run child()
    while handle != 0:
      sync()
    end
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("seen"), "2");
}

TEST(ThreadTest, JoinWaitsForTheEndOfTheOther)
{
  ScriptRunner runner(R"(def test():
    global done = False
    thread child():
      sleep(0.02)
      done = True
    end
    handle = run child()
    join handle
    result = done
    join handle
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("result"), "True");
  EXPECT_GE(runner.cycles, 10);
}

TEST(ThreadTest, KillingAnEndedThreadIsNoError)
{
  ScriptRunner runner("def test():\n kill 0\n kill 99\n x = 1\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(ThreadTest, KillingAThreadCancelsItsMotion)
{
  Motion motion;
  ScriptRunner runner(
      "def test():\n thread mover():\n move()\n end\n h = run mover()\n sleep(0.01)\n kill h\n sleep(1)\nend",
      library_with(motion));
  for (int i = 0; i < 10; ++i) {
    runner.machine->cycle();
  }
  EXPECT_EQ(motion.started, 1);
  EXPECT_EQ(motion.abandoned, 1);
  EXPECT_EQ(runner.machine->thread_count(), 1U);
}

TEST(ThreadTest, StoppingTheProgramCancelsOperations)
{
  Motion motion;
  ScriptRunner runner("def test():\n move()\nend", library_with(motion));
  runner.machine->cycle();
  runner.machine->stop();
  runner.machine->stop();
  EXPECT_EQ(motion.abandoned, 1);
  EXPECT_EQ(runner.machine->status(), MachineStatus::finished);
  EXPECT_EQ(runner.machine->cycle(), MachineStatus::finished);
}

TEST(ThreadTest, DestroyingTheMachineCancelsOperations)
{
  Motion motion;
  ScriptRunner runner("def test():\n move()\nend", library_with(motion));
  runner.machine->cycle();
  runner.machine.reset();
  EXPECT_EQ(motion.abandoned, 1);
}

TEST(ThreadTest, EndWithTheMainThread)
{
  Motion motion;
  ScriptRunner runner("def test():\n thread mover():\n move()\n end\n run mover()\n sync()\nend",
                      library_with(motion));
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(motion.abandoned, 1);
}

TEST(ThreadTest, KillingAThreadKillsTheThreadsItHasStarted)
{
  ScriptRunner runner(R"(def test():
    global count = 0
    thread grandchild():
      while True:
        count = count + 1
        sync()
      end
    end
    thread child():
      run grandchild()
      sleep(10)
    end
    handle = run child()
    sleep(0.01)
    kill handle
    at_kill = count
    sleep(10)
  end)");
  for (int i = 0; i < 20; ++i) {
    runner.machine->cycle();
  }
  EXPECT_EQ(runner.machine->thread_count(), 1U);
  EXPECT_NE(runner.global("count"), "0");
  EXPECT_EQ(runner.global("count"), runner.global("at_kill"));
}

/// Counts the cycles in which another thread than the main thread runs.
std::string with_counter(const std::string & main)
{
  return "def test():\n global count = 0\n thread counter():\n while True:\n count = count + 1\n sync()\n"
         " end\n end\n counting = run counter()\n sync()\n" +
         main + "\nend";
}

TEST(CriticalSectionTest, ALongComputationInItDelaysOtherThreads)
{
  ScriptRunner runner(
      with_counter("enter_critical\n i = 0\n while i < 20000:\n i = i + 1\n end\n seen = count\n"
                   " exit_critical\n sleep(10)"));
  while (runner.global("seen").empty()) {
    ASSERT_EQ(runner.machine->cycle(), MachineStatus::running);
    ++runner.cycles;
  }
  EXPECT_GT(runner.cycles, 5);
  EXPECT_EQ(runner.global("seen"), "1");
  runner.machine->cycle();
  EXPECT_EQ(runner.global("count"), "3");  // also in the cycle in which the section ended
}

TEST(CriticalSectionTest, OtherThreadsRunWhileAMotionInItIsInProgress)
{
  Motion motion;
  ScriptRunner runner(with_counter("enter_critical\n move()\n exit_critical\n sleep(10)"),
                      library_with(motion));
  for (int i = 0; i < 20; ++i) {
    runner.machine->cycle();
  }
  EXPECT_EQ(runner.global("count"), "20");
}

TEST(CriticalSectionTest, ExcludesOtherThreadsAgainAfterAWait)
{
  ScriptRunner runner(
      with_counter("enter_critical\n sync()\n before = count\n i = 0\n"
                   " while i < 20000:\n i = i + 1\n end\n after = count\n exit_critical"));
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_GT(runner.cycles, 5);
  EXPECT_EQ(runner.global("after"), runner.global("before"));
}

TEST(CriticalSectionTest, AThreadCanJoinAnotherThatEntersItsOwnSection)
{
  ScriptRunner runner(R"(def test():
    thread child():
      enter_critical
      sleep(0.01)
      x = 1
      exit_critical
    end
    global x = 0
    enter_critical
    handle = run child()
    join handle
    exit_critical
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(CriticalSectionTest, AnInfiniteLoopInItFailsTheProgram)
{
  ScriptRunner runner(with_counter("enter_critical\n while True:\n end\n exit_critical"));
  EXPECT_EQ(runner.finish(2000), MachineStatus::failed);
  EXPECT_NE(runner.machine->error().message.find("infinite loop"), std::string::npos);
}

TEST(CriticalSectionTest, EndsWithItsThread)
{
  ScriptRunner runner(R"(def test():
    thread selfish():
      enter_critical
    end
    run selfish()
    sync()
    x = 1
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(ThreadTest, TakeParameters)
{
  ScriptRunner runner(
      "def test():\n global x = 0\n thread t(a, b):\n x = a + b\n end\n h = run t(1, b = 2)\n join h\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "3");
}

TEST(ThreadTest, SleepTakesItsTimeInCycles)
{
  ScriptRunner runner("def test():\n sleep(0.01)\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.cycles, 6);
}

TEST(ThreadTest, ALongComputationContinuesInTheNextCycle)
{
  ScriptRunner runner("def test():\n i = 0\n while i < 20000:\n i = i + 1\n end\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_GT(runner.cycles, 1);
  EXPECT_EQ(runner.global("i"), "20000");
}

TEST(ThreadTest, AComputingThreadDoesNotStarveOthers)
{
  MachineOptions options;
  options.infinite_loop_after = 10.0;
  ScriptRunner runner(R"(def test():
    global count = 0
    thread greedy():
      while True:
      end
    end
    run greedy()
    while True:
      count = count + 1
      sync()
    end
  end)",
                      standard_library(), options);
  for (int i = 0; i < 50; ++i) {
    runner.machine->cycle();
    EXPECT_LE(runner.machine->instructions(), 2 * options.instructions_per_cycle);
  }
  EXPECT_EQ(runner.global("count"), "50");
}

TEST(ThreadTest, AThreadThatNeverTakesTimeFailsAsInfiniteLoop)
{
  ScriptRunner runner("def test():\n x = 0\n while True:\n x = 1 - x\n end\nend");
  EXPECT_EQ(runner.finish(2000), MachineStatus::failed);
  EXPECT_NE(runner.machine->error().message.find("infinite loop"), std::string::npos);
  EXPECT_NEAR(runner.cycles, 1000, 2);
}

TEST(ThreadTest, AreLimitedInNumber)
{
  ScriptRunner runner("def test():\n thread t():\n sleep(9)\n end\n while True:\n run t()\n end\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::failed);
  EXPECT_NE(runner.machine->error().message.find("number of threads exceeds 64"), std::string::npos);
}

TEST(ThreadTest, AnErrorInOneEndsTheProgram)
{
  Motion motion;
  ScriptRunner runner("def test():\n thread t():\n x = 1 / 0\n end\n run t()\n move()\nend",
                      library_with(motion));
  EXPECT_EQ(runner.finish(), MachineStatus::failed);
  EXPECT_EQ(runner.machine->error().line, 3);
  EXPECT_EQ(motion.abandoned, 1);
}

TEST(SecondaryProgramTest, MayNotTakePhysicalTime)
{
  ScriptRunner fine("sec test():\n textmsg(\"hello\")\nend");
  EXPECT_EQ(fine.finish(), MachineStatus::finished);
  EXPECT_EQ(fine.host.messages, std::vector<std::string>{"hello"});

  Motion motion;
  ScriptRunner moves("sec test():\n move()\nend", library_with(motion));
  EXPECT_EQ(moves.finish(), MachineStatus::failed);
  EXPECT_NE(moves.machine->error().message.find("physical time"), std::string::npos);
  EXPECT_EQ(motion.abandoned, 1);
}

}  // namespace
}  // namespace ur_simulator::urscript
