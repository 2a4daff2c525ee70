// The control script of ur_rtde follows setpoints of servoj that arrive late.
#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

#include "control_script_fixture.hpp"

namespace ur_simulator {
namespace {

constexpr int servo_j = 11;
constexpr int servo_stop = 16;
constexpr int bridged_cycles = 5;   // the longest gap that the script bridges; the sender skips the rest
constexpr double step = 0.001;      // rad in one cycle, 0.5 rad/s
constexpr double tolerance = 1e-6;  // rad; registers have 32 bits
constexpr std::size_t ahead_register = 12;

/// A sender that answers each cycle with a setpoint, and a connection that delays it.
struct ServoSetpointsTest : ControlScriptTest {
  /// Cycles by which the setpoint that is sent in a cycle is late.
  using Delay = std::function<int(int cycle)>;
  /// rad in one cycle.
  using Speed = std::function<double(double time)>;

  double sent_time = 1000.0;  ///< cycles, of the newest setpoint
  double position = 0.0;      ///< rad, of the newest setpoint

  Vector6 home;
  void SetUp() override
  {
    ControlScriptTest::SetUp();
    home = fixture.state.target.position;
  }

  void send(double time, double offset)
  {
    Vector6 target = home;
    target[5] += offset;
    parameters(target, {0.0, 0.0, 0.002, 0.1, 600.0, time});
    fixture.state.inputs.integers[0] = servo_j;
  }
  /// Time of the target after that of the newest setpoint.
  double ahead() const { return fixture.state.outputs.floats[ahead_register]; }
  double target() const { return fixture.machine->global("servo_target")->vector6()->coeff(5); }

  /// Moves for `cycles`, more slowly while the target is behind. Returns its distance in each cycle, in
  /// steps.
  std::vector<double> follow(
      int cycles, const Delay & delay, const Speed & speed = [](double) { return step; })
  {
    const double begin = sent_time;
    struct Package {
      int arrival;
      double time, position;
    };
    std::vector<Package> way;
    std::vector<double> steps;
    double last = 0.0;
    for (int cycle = 0; cycle < cycles; ++cycle) {
      const double pace = ahead() < -1.0 ? 0.9 : 1.0;
      sent_time += pace;
      position += pace * speed(sent_time - begin);
      // TCP keeps the order: a late package delays those behind it.
      const int arrival = std::max(cycle + delay(cycle), way.empty() ? 0 : way.back().arrival);
      way.push_back({arrival, sent_time, position});
      for (const Package & package : way) {
        if (package.arrival == cycle) {
          send(package.time, package.position);
        }
      }
      fixture.cycle();
      steps.push_back((target() - last) / step);
      last = target();
    }
    return steps;
  }
};

void expect_single_steps(const std::vector<double> & steps, std::size_t from)
{
  for (std::size_t i = from; i < steps.size(); ++i) {
    ASSERT_NEAR(steps[i], 1.0, tolerance / step) << "cycle " << i;
  }
}

TEST_F(ServoSetpointsTest, WithoutDelayAreTheTarget)
{
  expect_single_steps(follow(100, [](int) { return 0; }), 2);
  EXPECT_NEAR(target(), home[5] + position, tolerance);
  expect_running();
}

TEST_F(ServoSetpointsTest, ThatAreACycleLateCauseNoDoubleStep)
{
  expect_single_steps(follow(300, [](int cycle) { return cycle % 7 == 3 ? 1 : 0; }), 2);
}

TEST_F(ServoSetpointsTest, ThatAreUpToFourCyclesLateCauseNoDoubleStep)
{
  expect_single_steps(follow(300, [](int cycle) { return cycle % 20 == 9 ? 4 : 0; }), 2);
}

TEST_F(ServoSetpointsTest, ThatCrossTheBoundaryOfTheCycleCauseNoDoubleStep)
{
  // The first setpoint defines the alignment; half of the others are a cycle later.
  expect_single_steps(follow(300, [](int cycle) { return (cycle / 3) % 2; }), 2);
}

TEST_F(ServoSetpointsTest, AreFollowedWhileTheRegisterHoldsAQuery)
{
  constexpr int get_step_time = 26;
  follow(100, [](int) { return 0; });
  for (const int command : {get_step_time, get_step_time, 0, 0}) {
    const double before = target();
    fixture.state.inputs.integers[0] = command;
    fixture.cycle();
    EXPECT_NEAR((target() - before) / step, 1.0, tolerance / step) << command;
  }
  expect_running();
}

TEST_F(ServoSetpointsTest, WithoutTimesCauseDoubleSteps)
{
  Vector6 q = home;
  double largest = 0.0;
  for (int cycle = 0; cycle < 100; ++cycle) {
    q[5] += step;
    const double before = target();
    if (cycle % 10 != 5) {  // this setpoint arrives together with the next one
      parameters(q, {0.0, 0.0, 0.002, 0.1, 600.0, 0.0});
      fixture.state.inputs.integers[0] = servo_j;
    }
    fixture.cycle();
    largest = cycle == 0 ? 0.0 : std::max(largest, (target() - before) / step);
  }
  EXPECT_NEAR(largest, 2.0, tolerance / step) << "this is what the times prevent";
}

TEST_F(ServoSetpointsTest, StandStillInALongGapAndThenContinueWhereTheyWere)
{
  follow(100, [](int) { return 0; });
  const double before = target();
  fixture.cycles(50);
  EXPECT_NEAR(target(), before + 4 * step, tolerance);
  sent_time += bridged_cycles;
  position += bridged_cycles * step;
  send(sent_time, position);
  fixture.cycle();
  EXPECT_NEAR(target(), before + 5 * step, tolerance) << "one step";
  expect_single_steps(follow(50, [](int) { return 0; }), 1);
}

TEST_F(ServoSetpointsTest, ThatArriveInABunchMakeTheTargetNoFaster)
{
  follow(200, [](int) { return 0; });
  EXPECT_NEAR(ahead(), 0.0, 1e-4);
  const auto late = follow(30, [](int cycle) { return cycle == 5 ? 20 : 0; });
  EXPECT_LT(ahead(), -10.0) << "the sender can see that the target is behind";
  const auto after = follow(800, [](int) { return 0; });
  for (const auto & steps : {late, after}) {
    EXPECT_GE(*std::min_element(steps.begin() + 2, steps.end()), -tolerance / step);
    EXPECT_LE(*std::max_element(steps.begin() + 2, steps.end()), 1.0 + tolerance / step);
  }
  EXPECT_NEAR(after.back(), 1.0, tolerance / step);
  EXPECT_LT(home[5] + position - target(), 2.1 * step) << "it has caught up";
}

TEST_F(ServoSetpointsTest, OfABrakingSenderMakeTheTargetNoFaster)
{
  const Speed speed = [](double time) { return step * std::clamp(3.0 - time / 100.0, 0.0, 1.0); };
  const auto steps = follow(600, [](int cycle) { return cycle % 100 == 50 ? 12 : 0; }, speed);
  EXPECT_LE(*std::max_element(steps.begin() + 2, steps.end()), 1.0 + tolerance / step);
  EXPECT_NEAR(steps.back(), 0.0, tolerance / step);
  EXPECT_NEAR(target(), home[5] + position, tolerance);
}

TEST_F(ServoSetpointsTest, OfAnEndedStreamLeaveNoTimeBehind)
{
  follow(60, [](int cycle) { return cycle == 30 ? 12 : 0; });
  EXPECT_LT(ahead(), -1.0);
  fixture.state.inputs.integers[0] = servo_stop;
  parameters(home, {5.0});
  fixture.cycles(2);
  EXPECT_EQ(ahead(), 0.0);
}

TEST_F(ServoSetpointsTest, AreNotExtrapolatedBeyondTheEnd)
{
  follow(50, [](int) { return 0; });
  sent_time += 1.0;
  send(sent_time, position);  // the same position again
  fixture.cycles(20);
  EXPECT_NEAR(target(), home[5] + position, tolerance);
}

TEST_F(ServoSetpointsTest, OfANewStreamStartAtItsFirst)
{
  follow(50, [](int) { return 0; });
  sent_time = 10.0;
  send(sent_time, position);
  fixture.cycle();
  EXPECT_NEAR(target(), home[5] + position, tolerance);
}

}  // namespace
}  // namespace ur_simulator
