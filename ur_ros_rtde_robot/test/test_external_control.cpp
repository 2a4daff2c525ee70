#include <arpa/inet.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmath>

#include "program/script_server.hpp"
#include "robot_fixture.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

/// A port on which no process listens.
std::uint16_t free_port()
{
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ::bind(descriptor, reinterpret_cast<const sockaddr *>(&address), sizeof(address));
  socklen_t size = sizeof(address);
  ::getsockname(descriptor, reinterpret_cast<sockaddr *>(&address), &size);
  ::close(descriptor);
  return ntohs(address.sin_port);
}

struct ExternalControlTest : RobotFixture {
  const std::uint16_t port = free_port();

  RobotOptions options() const
  {
    RobotOptions result = robot_options();
    result.control_mode = ControlMode::control_urcap;
    result.urcap_port = port;
    return result;
  }

  void start(const RobotOptions & robot_options, bool remote_control = true)
  {
    auto simulator = Controller::options();
    simulator.remote_control = remote_control;
    controller.start(simulator);
    controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
    make_robot(robot_options);
    ASSERT_TRUE(waits_for_play());
  }

  void play() { controller.control({{"command", "play"}}); }

  /// The status tells the operator what to do.
  testing::AssertionResult waits_for_play()
  {
    if (!eventually(
            [&] {
              return robot->status().message.find("External Control node on the pendant") !=
                     std::string::npos;
            },
            10s)) {
      return testing::AssertionFailure() << robot->status().message << "\n" << log.text();
    }
    return comes_to(RobotState::stopped, ErrorCode::program_stopped);
  }

  /// The arm does not move for a while although the control program runs.
  testing::AssertionResult keeps_still()
  {
    const bool moves = eventually([&] { return !at_rest(); }, 400ms);
    return moves ? testing::AssertionFailure() << "it moves" : testing::AssertionSuccess();
  }

  testing::AssertionResult works()
  {
    auto there = robot->receive()->getActualQ();
    there[5] += 0.02;
    const auto mark = robot->mark_motion();
    if (!control()->moveJ(there, 1.0, 2.0, true) ||
        !eventually([&] { return robot->motion_progress(mark).finished(); })) {
      return testing::AssertionFailure() << "it does not move\n" << log.text();
    }
    return testing::AssertionSuccess();
  }
};

TEST_F(ExternalControlTest, BecomesReadyWhenTheProgramIsPlayed)
{
  start(options());
  EXPECT_NE(robot->status().message.find(std::to_string(port)), std::string::npos) << robot->status().message;
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  EXPECT_FALSE(robot->ready_to_move());
  EXPECT_FALSE(eventually([&] { return robot->latest()->is_program_running(); }, 400ms))
      << "nobody has played it";
  play();
  ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); })) << log.text();
  const double begin = robot->latest()->controller_time;
  ASSERT_TRUE(becomes_ready());
  const double after = robot->latest()->controller_time - begin;
  RecordProperty("ready_after_play_s", std::to_string(after));
  EXPECT_LT(after, 1.0);
  EXPECT_TRUE(robot->ready_to_move());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, LeavesCodeOutThatIsIncompleteInThisVersionOfTheController)
{
  controller.start();
  controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
  robot = std::make_unique<Robot>(options(), log.function());
  ScriptExtension half;
  half.name = "half";
  half.snippet = "$5.90 if True:\n  sync()\nend";
  ASSERT_TRUE(robot->set_extensions({half}).empty());
  robot->start();
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready()) << log.text();
  EXPECT_EQ(log.count("[error] the extension half is left out"), 1U) << log.text();
  EXPECT_FALSE(robot->has_extension("half"));
}

/// PolyScope would not start a program with an unknown function.
TEST_F(ExternalControlTest, HasTheExtensionsOfAUrcapOnlyIfTheUserSaysThatItIsInstalled)
{
  auto simulator = Controller::options();
  simulator.urcaps = {"onrobot_soft_gripper"};
  controller.start(simulator);
  controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
  ScriptExtension gripper;
  gripper.name = "gripper";
  gripper.snippet = "get_sg_Width()";
  gripper.urcap = "the OnRobot URCap";
  gripper.urcap_functions = {"get_sg_Width"};
  for (const bool is_installed : {false, true}) {
    auto robot_options = options();
    robot_options.urcap_extensions = is_installed;
    robot = std::make_unique<Robot>(robot_options, log.function());
    ASSERT_TRUE(robot->set_extensions({gripper}).empty());
    robot->start();
    ASSERT_TRUE(waits_for_play());
    play();
    ASSERT_TRUE(becomes_ready()) << log.text();
    const auto found = robot->has_extension("gripper");
    EXPECT_EQ(found.has_value(), is_installed);
    if (!found) {
      EXPECT_NE(found.error().message.find("urcap_extensions"), std::string::npos) << found.error().message;
    }
    robot.reset();
  }
}

TEST_F(ExternalControlTest, EndsTheMotionAndWaitsForPlayWhenStoppedOnThePendant)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::program_stopped);
  ASSERT_TRUE(waits_for_play());
  EXPECT_FALSE(eventually([&] { return robot->latest()->is_program_running(); }, 700ms))
      << "it was the operator";
  EXPECT_TRUE(at_rest());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, DoesNotExecuteTheCommandOfAnEarlierProgram)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  control()->speedJ({0.0, 0.0, 0.0, 0.0, 0.0, 0.3}, 2.0, 0.0);
  ASSERT_TRUE(eventually([&] { return !at_rest(); }));
  {
    const auto kept = robot->control_for_queries().hold();  // so that the driver is late to connect again
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(eventually([&] { return !robot->latest()->is_program_running() && at_rest(); }));
    play();
    ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); }));
    EXPECT_TRUE(keeps_still());
  }
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, EndsTheProgramWithItsNode)
{
  start(options());
  controller.control({{"command", "store_external_control"},
                      {"host", own_address()},
                      {"port", port},
                      {"next", "movej([1, -1.5, 1.5, -1.5, -1.5, 0], a=5, v=2)"}});
  play();
  ASSERT_TRUE(becomes_ready());
  // False if the driver has seen the end first, and abandons the command.
  static_cast<void>(control()->stopScript());
  ASSERT_TRUE(eventually([&] { return !robot->latest()->is_program_running(); }));
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, DoesNotResumeTheMotionOfAPausedProgram)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, LeavesAPausedProgramToItsWatchdogInLocalControl)
{
  start(options(), false);
  play();
  ASSERT_TRUE(becomes_ready()) << "local control is where the URCap is for";
  move_joints();
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, WaitsForPlayAfterLostLinksWithoutResumingTheMotion)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  std::size_t times = 1;
  for (const bool reset : {false, true}) {
    move_joints();
    controller.control({{"command", "drop_links"}, {"reset", reset}});
    ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
    ASSERT_TRUE(waits_for_play());
    EXPECT_FALSE(robot->latest()->is_program_running());
    play();
    ASSERT_TRUE(becomes_ready_again(++times));
    EXPECT_TRUE(keeps_still());
    EXPECT_TRUE(works());
  }
}

TEST_F(ExternalControlTest, WaitsForPlayAfterOnlyTheControlLinkWasLost)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "control"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready_again());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, DoesNotResumeTheMotionAfterAProtectiveStop)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  controller.control({{"command", "protective_stop"}, {"reason", "test"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
  ASSERT_TRUE(eventually(
      [&] {
        try {
          robot->dashboard()->unlockProtectiveStop();  // rejected for 5 s
          return true;
        } catch (const std::exception &) {
          return false;
        }
      },
      20s));
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, WaitsForPlayAfterAReboot)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  controller.control({{"command", "reboot"}, {"duration", 0.3}});
  ASSERT_TRUE(comes_to(RobotState::disconnected, ErrorCode::link_lost));
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  controller.control({{"command", "power"}, {"to", "running"}});
  ASSERT_TRUE(waits_for_play());
  controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, DistinguishesTheControlProgramFromAnotherOne)
{
  start(options());
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("not the control program") != std::string::npos;
  })) << robot->status().message;
  EXPECT_NE(robot->status().message.find("the External Control URCap has not fetched it"), std::string::npos);
  EXPECT_TRUE(robot->latest()->is_program_running()) << "it is left alone";
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  EXPECT_TRUE(becomes_ready());
}

TEST_F(ExternalControlTest, LeavesAForeignProgramAloneThatIsPaused)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("has replaced the control program") != std::string::npos;
  })) << robot->status().message;
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("will not be resumed") != std::string::npos;
  })) << robot->status().message;
  EXPECT_FALSE(eventually([&] { return controller.state().at("program").at("state") != "PAUSED"; }, 700ms));
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  EXPECT_TRUE(becomes_ready());
}

TEST_F(ExternalControlTest, DoesNotAdoptAProgramInTheMiddleOfAMotion)
{
  auto robot_side = options();
  robot_side.watchdog_frequency = 0.0;
  start(robot_side);
  play();
  ASSERT_TRUE(becomes_ready());
  controller.control({{"command", "remote_control"}, {"on", false}});
  ASSERT_TRUE(eventually([&] { return robot->dashboard()->isInRemoteControl() == false; }, 3s));
  move_joints();
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("before the driver was connected") != std::string::npos;
  })) << robot->status().message;
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, RejectsScriptsThatWouldReplaceTheProgram)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  const auto report = run_script("textmsg(\"no\")");
  EXPECT_EQ(report.end, ScriptEnd::rejected);
  EXPECT_EQ(report.error.code, ErrorCode::not_supported);
  EXPECT_NE(report.error.message.find("control_urcap"), std::string::npos) << report.error.message;
  EXPECT_TRUE(works()) << "nothing has happened";
  ScriptOptions beside;
  beside.kind = ScriptKind::secondary;
  beside.timeout = 5s;
  EXPECT_TRUE(run_script("sec f():\n  textmsg(\"yes\")\nend\n", beside));
  EXPECT_TRUE(robot->ready_to_move());
}

TEST_F(ExternalControlTest, StopsTheProgramWhenTheDriverEnds)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  robot.reset();
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
  EXPECT_TRUE(eventually([&] { return controller.state().at("at_rest") == true; }));
}

TEST_F(ExternalControlTest, ReportsThatItsPortIsInUse)
{
  controller.start();
  ScriptServer other(port, 50ms, {[] { return std::nullopt; }, [](const auto &) { return ""; }}, {});
  other.start();
  ASSERT_TRUE(eventually([&] { return other.status().has_value(); }));
  make_robot(options());
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  ASSERT_TRUE(eventually([&] { return robot->status().message.find("in use") != std::string::npos; }))
      << robot->status().message;
  EXPECT_NE(robot->status().message.find("urcap_port"), std::string::npos);
  EXPECT_NE(robot->status().message.find(std::to_string(port)), std::string::npos);
  EXPECT_EQ(log.count("in use"), 1U) << log.text();
  other.stop();
  EXPECT_TRUE(waits_for_play());
}

struct ScriptServerTest : testing::Test {
  const std::uint16_t port = free_port();
  Log log;
  std::atomic<bool> known{true};
  ScriptServer server{
      port,
      50ms,
      {[this] { return known ? std::optional(ControllerVersion{5, 11, 0, 0}) : std::nullopt; },
       [](const ControllerVersion & version) {
         return std::string(1'000'000, 'x') + std::to_string(version.minor) + "\n";
       }},
      log.function()};

  void SetUp() override
  {
    server.start();
    ASSERT_TRUE(eventually([&] { return server.status().has_value(); }));
  }

  TcpSocket connect() { return std::move(TcpSocket::connect(own_address(), port, 1s).value()); }
};

TEST_F(ScriptServerTest, SendsTheWholeProgramToEachClient)
{
  TcpSocket silent = connect();
  for (int i = 0; i < 2; ++i) {
    TcpSocket client = connect();
    ASSERT_TRUE(client.write("request_", Clock::now() + 1s));
    ASSERT_TRUE(client.write("program\n", Clock::now() + 1s));
    std::vector<std::byte> program(1'000'003);
    ASSERT_TRUE(client.read(program, Clock::now() + 5s));
    EXPECT_EQ(std::to_integer<char>(program[1'000'001]), '1');
  }
  EXPECT_EQ(server.fetched(), 2U);
}

TEST_F(ScriptServerTest, ClosesTheConnectionAfterAnUnknownRequest)
{
  for (const std::string request : {"GET / HTTP/1.1\r\n", "request_program_or_whatever\n"}) {
    TcpSocket client = connect();
    ASSERT_TRUE(client.write(request + std::string(200, 'x'), Clock::now() + 1s));
    std::byte answer{};
    const auto status = client.read(std::span(&answer, 1), Clock::now() + 5s);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message.find("does not answer"), std::string::npos) << status.error().message;
  }
  EXPECT_EQ(server.fetched(), 0U);
}

/// While it exists, this process cannot open files.
class NoDescriptors {
 public:
  NoDescriptors()
  {
    ::getrlimit(RLIMIT_NOFILE, &limit_);
    while (true) {
      const int descriptor = ::dup(STDIN_FILENO);
      if (descriptor < 0 || opened_.size() == 4096) {
        break;
      }
      opened_.push_back(descriptor);
      rlimit lowered = limit_;
      lowered.rlim_cur = static_cast<rlim_t>(descriptor) + 1;
      ::setrlimit(RLIMIT_NOFILE, &lowered);
    }
  }
  ~NoDescriptors()
  {
    ::setrlimit(RLIMIT_NOFILE, &limit_);
    for (const int descriptor : opened_) {
      ::close(descriptor);
    }
  }
  NoDescriptors(const NoDescriptors &) = delete;
  NoDescriptors & operator=(const NoDescriptors &) = delete;

 private:
  rlimit limit_{};
  std::vector<int> opened_;
};

double processor_time()
{
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST_F(ScriptServerTest, WaitsWhenItCannotAcceptAConnection)
{
  const int client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, own_address().c_str(), &address.sin_addr);
  {
    const NoDescriptors none;
    ASSERT_EQ(::connect(client, reinterpret_cast<const sockaddr *>(&address), sizeof(address)), 0);
    const double begin = processor_time();
    std::this_thread::sleep_for(500ms);
    EXPECT_LT(processor_time() - begin, 0.1);
  }
  const std::string request = "request_program\n";
  ASSERT_EQ(::send(client, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  EXPECT_TRUE(eventually([&] { return server.fetched() == 1U; }));
  EXPECT_EQ(log.count("cannot serve the control program"), 1U) << log.text();
  ::close(client);
}

TEST_F(ScriptServerTest, SendsNothingWhileTheControllerIsUnknown)
{
  known = false;
  TcpSocket client = connect();
  ASSERT_TRUE(client.write("request_program\n", Clock::now() + 1s));
  std::byte answer{};
  EXPECT_FALSE(client.read(std::span(&answer, 1), Clock::now() + 5s));
  EXPECT_TRUE(eventually([&] { return log.count("press play again") == 1U; })) << log.text();
  EXPECT_EQ(server.fetched(), 0U);
}

}  // namespace
}  // namespace ur_ros_rtde::test
