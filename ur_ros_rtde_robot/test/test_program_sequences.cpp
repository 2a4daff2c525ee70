#include <gtest/gtest.h>

#include "program/program_state_machine.hpp"

namespace ur_ros_rtde::test {
namespace {

using S = ProgramState;
using E = ProgramEvent;
using A = ProgramAction;

class ProgramSequence {
 public:
  explicit ProgramSequence(ControlMode mode = ControlMode::upload, bool restart = true)
      : machine_(mode, restart)
  {
  }

  A process(E event) { return machine_.process(event, observation_); }
  A sample(ProgramActivity program)
  {
    observation_.program = program;
    return process(E::sample);
  }
  S state() const { return machine_.state(); }

  ProgramSequence & running()
  {
    process(E::link_established);
    process(E::robot_ready);
    sample(ProgramActivity::playing);
    process(E::program_started);
    return *this;
  }

 private:
  ProgramStateMachine machine_;
  ProgramObservation observation_;
};

TEST(ProgramSequenceTest, StartsTheControlProgramAfterItHasStoppedTheProgramOnTheRobot)
{
  ProgramSequence sequence;
  sequence.process(E::link_established);
  sequence.sample(ProgramActivity::playing);
  EXPECT_EQ(sequence.process(E::robot_ready), A::stop_program);
  sequence.sample(ProgramActivity::stopped);
  EXPECT_EQ(sequence.process(E::robot_ready), A::start_program);
  EXPECT_EQ(sequence.process(E::program_started), A::none);
  EXPECT_EQ(sequence.state(), S::running);
}

TEST(ProgramSequenceTest, EndsAPausedControlProgramBeforeTheRobotIsReady)
{
  auto sequence = ProgramSequence().running();
  EXPECT_EQ(sequence.sample(ProgramActivity::paused), A::close_control);
  EXPECT_EQ(sequence.process(E::inspection), A::stop_program);
  sequence.sample(ProgramActivity::stopped);
  EXPECT_EQ(sequence.state(), S::idle);
  EXPECT_EQ(sequence.process(E::robot_ready), A::start_program);
}

TEST(ProgramSequenceTest, EndsAPausedProgramOfALostConnectionBeforeTheRobotIsReady)
{
  auto sequence = ProgramSequence().running();
  sequence.process(E::link_lost);
  sequence.process(E::link_established);
  EXPECT_EQ(sequence.sample(ProgramActivity::paused), A::none);
  EXPECT_EQ(sequence.process(E::inspection), A::stop_program);
}

TEST(ProgramSequenceTest, EndsAProgramThatWasPausedWhenTheConnectionWasLost)
{
  auto sequence = ProgramSequence().running();
  EXPECT_EQ(sequence.sample(ProgramActivity::paused), A::close_control);
  sequence.process(E::link_lost);
  sequence.process(E::link_established);
  EXPECT_EQ(sequence.sample(ProgramActivity::paused), A::none);
  EXPECT_EQ(sequence.process(E::inspection), A::stop_program);
}

TEST(ProgramSequenceTest, TakesAProgramThatRunsAfterAFailedRestartForTheControlProgram)
{
  auto sequence = ProgramSequence().running();
  sequence.sample(ProgramActivity::stopped);
  EXPECT_EQ(sequence.process(E::robot_ready), A::start_program);
  sequence.process(E::start_failed);
  sequence.sample(ProgramActivity::playing);
  EXPECT_EQ(sequence.process(E::robot_ready), A::stop_program);
  sequence.sample(ProgramActivity::stopped);
  sequence.process(E::inspection);
  EXPECT_EQ(sequence.state(), S::idle);
  sequence.sample(ProgramActivity::playing);
  EXPECT_EQ(sequence.state(), S::foreign);
}

TEST(ProgramSequenceTest, StaysYieldedWhenTheConnectionIsLost)
{
  auto sequence = ProgramSequence().running();
  EXPECT_EQ(sequence.process(E::yield_requested), A::suspend_program);
  sequence.process(E::program_yielded);
  EXPECT_EQ(sequence.process(E::link_lost), A::close_interfaces);
  sequence.process(E::link_established);
  EXPECT_EQ(sequence.state(), S::yielded);
  EXPECT_EQ(control_owner(sequence.state()), ControlOwner::script);
  sequence.process(E::resume_requested);
  EXPECT_EQ(sequence.process(E::robot_ready), A::stop_program) << "the script may still run";
}

TEST(ProgramSequenceTest, LeavesTheProgramOfAnotherDriverAloneAfterBothLostTheirConnections)
{
  ProgramSequence sequence;
  sequence.process(E::link_established);
  sequence.process(E::inputs_in_use);
  sequence.process(E::link_lost);
  sequence.process(E::link_established);
  sequence.sample(ProgramActivity::playing);
  EXPECT_EQ(sequence.process(E::robot_ready), A::close_interfaces);
  sequence.sample(ProgramActivity::stopped);
  EXPECT_EQ(sequence.process(E::robot_ready), A::start_program);
}

}  // namespace
}  // namespace ur_ros_rtde::test
