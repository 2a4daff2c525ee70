#include <map>

#include "script_api/script_socket.hpp"
#include "support/script_runner.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;
using urscript::ScriptRunner;

struct FakeHost {
  std::string sent;      ///< by the program
  std::string received;  ///< what the program can read
  bool failed = false;
  int open = 0;  ///< sockets
};

class FakeSocket final : public ScriptSocket {
 public:
  explicit FakeSocket(FakeHost & host) : host_(host) { ++host_.open; }
  ~FakeSocket() override { --host_.open; }
  bool connected() const override { return !host_.failed; }
  bool failed() const override { return host_.failed; }
  void send(std::string_view bytes) override { host_.sent += bytes; }
  std::string & received() override { return host_.received; }

 private:
  FakeHost & host_;
};

class SocketBuiltinTest : public ::testing::Test {
 protected:
  /// Runs `body` with the open socket "socket_0" to its end.
  std::string run(const std::string & body, const std::string & name = "x")
  {
    runner = std::make_unique<ScriptRunner>("def test():\n socket_open(\"host\", 50001)\n" + body + "\nend",
                                            library());
    EXPECT_EQ(runner->finish(3000), MachineStatus::finished) << runner->machine->error().message;
    return runner->global(name);
  }
  std::shared_ptr<const urscript::Library> library()
  {
    return with_sockets(*urscript::standard_library(), [this](const std::string &, std::uint16_t) {
      return std::make_shared<FakeSocket>(host);
    });
  }

  FakeHost host;
  std::unique_ptr<ScriptRunner> runner;
};

TEST_F(SocketBuiltinTest, ReadsOfReceivedDataTakeNoTime)
{
  for (int i = 0; i < 40; ++i) {
    host.received += "line\n";
  }
  run(" n = 0\n while n < 40:\n socket_read_line()\n n = n + 1\n end");
  EXPECT_EQ(runner->cycles, 2);  // the first one opens the socket
}

TEST_F(SocketBuiltinTest, ReadsShareTheCyclesComputation)
{
  for (int i = 0; i < 400; ++i) {
    host.received += "line\n";
  }
  run(" n = 0\n while n < 400:\n socket_read_line()\n n = n + 1\n end");
  EXPECT_GT(runner->cycles, 8);
  EXPECT_LT(runner->cycles, 20);
}

TEST_F(SocketBuiltinTest, AThreadThatReadsAllTheTimeIsNoInfiniteLoop)
{
  runner = std::make_unique<ScriptRunner>(
      "def test():\n socket_open(\"host\", 50001)\n while True:\n socket_read_line()\n end\nend", library());
  for (int i = 0; i < 2000; ++i) {
    if (host.received.size() < 1000) {
      host.received.append(1000, '\n');
    }
    ASSERT_EQ(runner->machine->cycle(), MachineStatus::running) << runner->machine->error().message;
  }
}

TEST_F(SocketBuiltinTest, AFailedReadReturnsTheValuesOfTheManual)
{
  EXPECT_EQ(run(" x = socket_read_binary_integer(2, timeout=0.01)"), "[0, -1, -1]");
  EXPECT_EQ(run(" x = socket_read_byte_list(1, timeout=0.01)"), "[0, -1]");
  EXPECT_EQ(run(" x = socket_read_ascii_float(2, timeout=0.01)"), "[0, nan, nan]");
  EXPECT_EQ(run(" x = socket_read_ascii_float(1, \"other\")"), "[0, nan]");
  EXPECT_EQ(run(" x = str_len(socket_read_string(timeout=0.01))"), "0");
}

TEST_F(SocketBuiltinTest, NumbersHaveTheFormatOfTheManual)
{
  host.received = "( 1.414 , 3.14159, 1.616, 0.0 )";
  EXPECT_EQ(run(" x = socket_read_ascii_float(4)"), "[4, 1.414, 3.14159, 1.616, 0]");
  host.received = std::string("\xff\xff\xff\xfe\x00\x00\x00\x02\xff", 9);
  EXPECT_EQ(run(" x = socket_read_binary_integer(2)"), "[2, -2, 2]");
  EXPECT_EQ(run(" x = socket_read_byte_list(1)"), "[1, 255]");
  host.received = "(1, 2, three)";
  EXPECT_EQ(run(" x = socket_read_ascii_float(3)"), "[0, nan, nan, nan]");
}

TEST_F(SocketBuiltinTest, SendsNumbersAsMessagesContainThem)
{
  run(" socket_send_string(p[0.6768500000000001, 0, 1.0 / 3, 0, -2.7e-16, 0])\n socket_send_line(0.1 + 0.2)");
  EXPECT_EQ(host.sent, "p[0.67685,0,0.333333,0,-2.7e-16,0]0.3\n");
}

// The functions of Robotiq's URCap read 17 bytes where fewer arrive.
TEST_F(SocketBuiltinTest, AReadOfBytesReturnsThoseThatArrivedInTime)
{
  host.received = "[9]";
  EXPECT_EQ(run(" x = socket_read_byte_list(6, timeout=0.01)"), "[3, 91, 57, 93, -1, -1, -1]");
  EXPECT_EQ(host.received, "");
}

TEST_F(SocketBuiltinTest, PrefixAndSuffixMayBeEscapeSequences)
{
  host.received = "junk\tmessage\rrest";
  EXPECT_EQ(run(" x = socket_read_string(prefix=\"\\t\", suffix=\"\\r\", interpret_escape=True)"), "message");
  EXPECT_EQ(host.received, "rest");
}

TEST_F(SocketBuiltinTest, ATextWithoutEndIsCutAtTheLimitOfStrings)
{
  host.received.assign(60000, 'x');
  EXPECT_EQ(run(" x = str_len(socket_read_line())"), "16384");
  EXPECT_EQ(run(" x = str_len(socket_read_string())"), "1024");
  EXPECT_EQ(run(" x = str_len(socket_read_string(prefix=\"x\", suffix=\"y\"))"), "1024");
}

TEST_F(SocketBuiltinTest, VariablesAreReadAndWritten)
{
  host.received = "POS_X 12\n";
  EXPECT_EQ(run(" x = socket_get_var(\"POS_X\")\n socket_set_var(\"POS_Y\", 2200)"), "12");
  EXPECT_EQ(host.sent, "GET POS_X\nSET POS_Y 2200\n");
  host.received = "other 12\n";
  EXPECT_EQ(run(" x = socket_get_var(\"POS_X\")"), "0");
}

TEST_F(SocketBuiltinTest, AReadEndsWhenAnotherThreadClosesTheSocket)
{
  EXPECT_EQ(run(" thread closer():\n sleep(0.01)\n socket_close()\n end\n run closer()\n"
                " x = socket_read_binary_integer(1, timeout=0)"),
            "[0, -1]");
}

TEST_F(SocketBuiltinTest, TheNumberOfOpenSocketsIsLimited)
{
  run("i = 0\n while i < 300:\n socket_open(\"host\", 50001, to_str(i % 99))\n i = i + 1\n end\n x = 1");
  ScriptRunner many(
      "def many():\n i = 0\n while True:\n socket_open(\"host\", 50001, to_str(i))\n i = i + 1\n end\nend",
      library());
  EXPECT_EQ(many.finish(3000), MachineStatus::failed);
  EXPECT_NE(many.machine->error().message.find("100 sockets are open"), std::string::npos);
}

TEST_F(SocketBuiltinTest, SocketsAreClosedWhenTheProgramEndsHaltsOrFails)
{
  for (const std::string end : {"", " halt", " x = 1 / 0"}) {
    runner = std::make_unique<ScriptRunner>(
        "def test():\n socket_open(\"host\", 50001)\n socket_open(\"host\", 50001, \"second\")\n" + end +
            "\nend",
        library());
    runner->machine->cycle();
    runner->machine->cycle();
    EXPECT_EQ(host.open, 2);
    runner->finish();
    EXPECT_EQ(host.open, 0) << end;
  }
}

}  // namespace
}  // namespace ur_simulator
