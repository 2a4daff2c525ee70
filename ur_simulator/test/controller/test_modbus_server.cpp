#include <linux/capability.h>
#include <sys/syscall.h>

#include <fstream>

#include "support/bytes.hpp"
#include "support/flood.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

SimulatorOptions modbus_options(const std::string & model = "ur10e", const std::string & polyscope = "")
{
  SimulatorOptions options;
  options.model = model;
  options.polyscope_version = polyscope;
  options.ports.modbus = 0;
  options.ports.robot_api = 0;
  return options;
}

/// A client of the MODBUS server, which checks the headers of the responses.
class ModbusClient {
 public:
  explicit ModbusClient(SimulatedController & controller)
      : socket_(controller.address(), controller.ports().modbus)
  {
  }
  TcpClient & socket() { return socket_; }

  void send(const std::string & request)
  {
    socket_.send(bytes({0, ++transaction_, 0, 0, 0, static_cast<int>(request.size()) + 1, 255}) + request);
  }
  std::string receive()
  {
    const std::string header = socket_.receive(7);
    const int length = static_cast<unsigned char>(header[5]);
    EXPECT_EQ(header, bytes({0, transaction_, 0, 0, 0, length, 255}));
    return socket_.receive(static_cast<std::size_t>(length - 1));
  }
  std::string request(const std::string & pdu)
  {
    send(pdu);
    return receive();
  }
  int read_register(int address)
  {
    const std::string response = request(bytes({3, address >> 8, address & 0xff, 0, 1}));
    EXPECT_EQ(response.size(), 4U);
    return static_cast<unsigned char>(response[2]) << 8 | static_cast<unsigned char>(response[3]);
  }
  std::string write_register(int address, int value)
  {
    return request(bytes({6, address >> 8, address & 0xff, value >> 8, value & 0xff}));
  }

 private:
  TcpClient socket_;
  int transaction_ = 0;
};

class ModbusServerTest : public ::testing::Test {
 protected:
  SimulatedController controller{with_unique_address(modbus_options())};
  ModbusClient client{controller};

  void run_script(const std::string & script)
  {
    const json reply = controller.control({{"command", "run_script"}, {"script", script}});
    ASSERT_TRUE(reply["ok"]) << reply.dump();
  }
};

TEST_F(ModbusServerTest, ReadsTheStateOfTheRobot)
{
  const json state = controller.state();
  EXPECT_EQ(client.read_register(258), 7);
  EXPECT_EQ(client.read_register(260), 1);
  EXPECT_NEAR(static_cast<std::int16_t>(client.read_register(402)),
              1e4 * state["actual_tcp_pose"][2].get<double>(), 1.0);
  EXPECT_EQ(client.read_register(321), 65535);
}

TEST_F(ModbusServerTest, FollowsASafetyStop)
{
  ASSERT_TRUE(controller.control({{"command", "emergency_stop"}})["ok"]);
  ASSERT_TRUE(wait_for_safety_mode(controller, "ROBOT_EMERGENCY_STOP", seconds(10)));
  EXPECT_EQ(client.request(bytes({2, 1, 4, 0, 6})), bytes({2, 1, 0b100100}));
}

TEST_F(ModbusServerTest, ExchangesDataWithAProgram)
{
  EXPECT_EQ(client.write_register(130, 65535), bytes({6, 0, 130, 255, 255}));
  run_script(R"(def exchange():
    write_port_register(128, read_port_register(130) - 1)
    write_port_bit(16, True)
    write_port_register(129, 1)
  end)");
  while (client.read_register(129) != 1) {
    wait_for_next_cycle(controller);
  }
  EXPECT_EQ(client.read_register(128), 65534);
  EXPECT_EQ(client.request(bytes({1, 0, 16, 0, 1})), bytes({1, 1, 1}));
}

TEST_F(ModbusServerTest, SecondaryProgramsAccessThePorts)
{
  run_script("sec write():\n  write_port_register(140, 7)\nend\n");
  while (client.read_register(140) != 7) {
    wait_for_next_cycle(controller);
  }
}

TEST_F(ModbusServerTest, ServesSeveralClients)
{
  ModbusClient other(controller);
  EXPECT_EQ(client.write_register(200, 9), bytes({6, 0, 200, 0, 9}));
  EXPECT_EQ(other.read_register(200), 9);
  EXPECT_EQ(controller.state()["clients"]["modbus"], 2);
}

TEST_F(ModbusServerTest, AnswersPipelinedRequestsAndHalfClosedConnections)
{
  client.send(bytes({3, 0, 128, 0, 1}));
  client.socket().send(bytes({0, 2, 0, 0, 0, 6, 255, 6, 0, 128, 0, 5}));
  client.socket().shut_down_sending();
  EXPECT_EQ(client.receive(), bytes({3, 2, 0, 0}));
  EXPECT_EQ(client.socket().receive(12), bytes({0, 2, 0, 0, 0, 6, 255, 6, 0, 128, 0, 5}));
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(ModbusServerTest, ClosesConnectionsWithoutMessageEnds)
{
  for (const int length : {0, 1, 300, 65535}) {
    ModbusClient broken(controller);
    broken.send(bytes({3, 0, 128, 0, 1}));
    broken.socket().send(bytes({0, 2, 0, 0, length >> 8, length & 0xff, 255}));
    EXPECT_EQ(broken.receive(), bytes({3, 2, 0, 0})) << length;
    EXPECT_TRUE(broken.socket().closed_by_peer()) << length;
  }
  EXPECT_EQ(client.read_register(258), 7);
}

TEST_F(ModbusServerTest, ContainsClientsThatFloodOrDoNotRead)
{
  {
    // The simulator closes the connection of a client that does not read the responses.
    const Flood flood(controller.address(), controller.ports().modbus,
                      bytes({0, 1, 0, 0, 0, 6, 255, 3, 0, 128, 0, 125}));
    const Flood garbage(controller.address(), controller.ports().modbus, "garbage of any kind");
    EXPECT_TRUE(controller.wait_until([](const json & state) { return state["clients"]["modbus"] == 1; },
                                      seconds(20)));
    EXPECT_EQ(client.read_register(258), 7);
  }
  EXPECT_EQ(client.read_register(258), 7);
}

TEST_F(ModbusServerTest, ControlPortDropsItsClients)
{
  EXPECT_EQ(client.read_register(258), 7);
  EXPECT_EQ(controller.control({{"command", "drop_links"}, {"which", "modbus"}})["connections"], 1);
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(ModbusServerTest, RestartForgetsTheRegisters)
{
  client.write_register(128, 3);
  ASSERT_TRUE(controller.control({{"command", "reboot"}, {"duration", 0.1}})["ok"]);
  EXPECT_TRUE(client.socket().closed_by_peer());
  ASSERT_TRUE(wait_for_log(controller, "switched on"));
  EXPECT_EQ(ModbusClient(controller).read_register(128), 0);
}

TEST(ModbusVersionTest, EachVersionHasTheServer)
{
  for (const auto & [model, polyscope, major] :
       {std::tuple{"ur5", "3.15.8", 3}, std::tuple{"ur5e", "5.4", 5}, std::tuple{"ur10e", "10.12", 10}}) {
    SimulatedController controller(with_unique_address(modbus_options(model, polyscope)));
    EXPECT_EQ(ModbusClient(controller).read_register(256), major);
  }
}

/// The capability of this thread to open ports below 1024, which is restored at the end.
class WithoutPrivilegedPorts {
 public:
  WithoutPrivilegedPorts()
  {
    call(SYS_capget);
    initial_ = data_[0].effective;
    data_[0].effective &= ~(1U << CAP_NET_BIND_SERVICE);
    call(SYS_capset);
  }
  ~WithoutPrivilegedPorts()
  {
    data_[0].effective = initial_;
    call(SYS_capset);
  }
  WithoutPrivilegedPorts(const WithoutPrivilegedPorts &) = delete;
  WithoutPrivilegedPorts & operator=(const WithoutPrivilegedPorts &) = delete;

 private:
  void call(long number) { EXPECT_EQ(syscall(number, &header_, data_), 0); }

  __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data_[2]{};
  std::uint32_t initial_ = 0;
};

int first_unprivileged_port()
{
  int port = 1024;
  std::ifstream("/proc/sys/net/ipv4/ip_unprivileged_port_start") >> port;
  return port;
}

TEST(ModbusPortTest, RobotRunsWithoutTheServerIfItsPortNeedsPrivileges)
{
  const WithoutPrivilegedPorts without;
  SimulatedController controller(with_unique_address());
  if (first_unprivileged_port() <= 502) {
    EXPECT_EQ(controller.ports().modbus, 502);
    return;
  }
  EXPECT_EQ(controller.ports().modbus, 0);
  EXPECT_TRUE(
      log_contains(controller, "there is no MODBUS server: port 502 of " + controller.address() +
                                   " cannot be opened without privileges: select a port above 1023, such as "
                                   "--ports robot_api=8080 or --ports modbus=1502"));
  EXPECT_FALSE(controller.state()["clients"].contains("modbus"));
  const TcpClient dashboard(controller.address(), 29999);
}

TEST(ModbusPortTest, PortInUseIsAnError)
{
  SimulatedController first(with_unique_address(modbus_options()));
  SimulatorOptions options;
  options.address = first.address();
  options.ports.modbus = first.ports().modbus;
  for (std::uint16_t Ports::* port :
       {&Ports::primary, &Ports::secondary, &Ports::realtime, &Ports::rtde, &Ports::primary_read_only,
        &Ports::secondary_read_only, &Ports::realtime_read_only, &Ports::interpreter, &Ports::dashboard,
        &Ports::control}) {
    options.ports.*port = 0;
  }
  EXPECT_THROW(SimulatedController{options}, std::runtime_error);
}

}  // namespace
}  // namespace ur_simulator::testing
