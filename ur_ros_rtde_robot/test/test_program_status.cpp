#include <gtest/gtest.h>

#include "program/program_status.hpp"

namespace ur_ros_rtde::test {
namespace {

using S = ProgramState;

RobotOptions options_of(ControlMode mode, bool restart = true)
{
  RobotOptions options;
  options.control_mode = mode;
  options.restart_program = restart;
  return options;
}

TEST(ProgramStatusTest, StatesWhyAnUploadedProgramDoesNotRun)
{
  const auto message = [](S state, ProgramActivity program, bool remote = true, bool restart = true) {
    return program_status(state, {program, remote}, RuntimeState::playing,
                          options_of(ControlMode::upload, restart))
        .message;
  };
  constexpr auto npos = std::string::npos;
  EXPECT_NE(message(S::foreign, ProgramActivity::playing).find("another program runs"), npos);
  EXPECT_NE(message(S::foreign, ProgramActivity::paused).find("another program is paused"), npos);
  EXPECT_NE(message(S::in_use, ProgramActivity::playing, false).find("but not its program"), npos);
  EXPECT_NE(message(S::in_use_after_end, ProgramActivity::paused).find("but not its program"), npos);
  EXPECT_NE(message(S::foreign, ProgramActivity::playing, false).find("local control"), npos);
  EXPECT_NE(message(S::unclaimed, ProgramActivity::stopped, false).find("local control"), npos);
  EXPECT_NE(message(S::idle, ProgramActivity::stopped, true, false).find("restart_program is off"), npos);
}

TEST(ProgramStatusTest, StatesWhyAFetchedProgramDoesNotRun)
{
  const auto message = [](S state, ProgramActivity program, RuntimeState runtime) {
    return program_status(state, {program, false}, runtime, options_of(ControlMode::control_urcap)).message;
  };
  constexpr auto npos = std::string::npos;
  for (const auto state : {S::unclaimed, S::orphaned}) {
    EXPECT_NE(message(state, ProgramActivity::playing, RuntimeState::playing)
                  .find("before the driver was connected"),
              npos);
  }
  EXPECT_NE(message(S::foreign, ProgramActivity::playing, RuntimeState::playing).find("has replaced"), npos);
  EXPECT_NE(message(S::foreign, ProgramActivity::paused, RuntimeState::pausing).find("is PAUSING"), npos);
  EXPECT_NE(message(S::idle, ProgramActivity::stopped, RuntimeState::stopped).find("port 50002"), npos);
}

}  // namespace
}  // namespace ur_ros_rtde::test
