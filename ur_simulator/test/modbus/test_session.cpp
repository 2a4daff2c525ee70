#include <gtest/gtest.h>

#include "modbus/session.hpp"
#include "support/bytes.hpp"

namespace ur_simulator::modbus {
namespace {

using testing::bytes;

class ModbusSessionTest : public ::testing::Test {
 protected:
  ControllerState state;
  PortMap ports{state, {5, 25, 1, 0}};
  Session session{ports};
  const std::string request = bytes({0xab, 0xcd, 0, 0, 0, 6, 255, 3, 0, 128, 0, 1});
  const std::string response = bytes({0xab, 0xcd, 0, 0, 0, 5, 255, 3, 2, 0, 0});
};

TEST_F(ModbusSessionTest, RepeatsTransactionAndUnit)
{
  const Session::Reply reply = session.receive(request);
  EXPECT_EQ(reply.bytes, response);
  EXPECT_EQ(reply.error, "");
}

TEST_F(ModbusSessionTest, TakesRequestsInPiecesOfAnySize)
{
  const std::string stream = request + request;
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    std::string replies;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      replies += session.receive(std::string_view(stream).substr(at, piece)).bytes;
    }
    EXPECT_EQ(replies, response + response) << piece;
  }
}

TEST_F(ModbusSessionTest, DiscardsMessagesOfOtherProtocols)
{
  EXPECT_EQ(session.receive(bytes({0, 1, 0, 1, 0, 6, 255, 3, 0, 128, 0, 1})).bytes, "");
  EXPECT_EQ(session.receive(request).bytes, response);
}

TEST_F(ModbusSessionTest, AnswersShortestMessageWithException)
{
  EXPECT_EQ(session.receive(bytes({0, 1, 0, 0, 0, 2, 255, 3})).bytes,
            bytes({0, 1, 0, 0, 0, 3, 255, 0x83, 3}));
}

TEST_F(ModbusSessionTest, ReportsLengthsThatNoMessageHas)
{
  for (const auto & [high, low, length] : {std::tuple{0, 0, 0}, std::tuple{0, 1, 1}, std::tuple{0, 255, 255},
                                           std::tuple{1, 0x2c, 300}, std::tuple{255, 255, 65535}}) {
    Session other(ports);
    const Session::Reply reply = other.receive(request + bytes({0, 1, 0, 0, high, low, 255, 3}));
    EXPECT_EQ(reply.bytes, response);
    EXPECT_EQ(reply.error,
              "the length of a MODBUS message is " + std::to_string(length) + ": it must be 2 to 254");
  }
}

}  // namespace
}  // namespace ur_simulator::modbus
