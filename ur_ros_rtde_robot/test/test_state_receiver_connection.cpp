#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <future>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "state_receiver_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

using StateReceiverConnectionTest = StateReceiverTest;

TEST_F(StateReceiverConnectionTest, StartsBeforeTheController)
{
  const auto receiver = this->receiver();
  ASSERT_TRUE(eventually([&] {
    return log.count("no connection to " + own_address() + ":30004") == 1 &&
           log.count("check the address") == 1;
  })) << log.text();
  EXPECT_FALSE(receiver->latest());
  controller.start();
  EXPECT_TRUE(connected(*receiver)) << log.text();
}

TEST_F(StateReceiverConnectionTest, LogsAMissingControllerOnceWithAddressAndRetryInterval)
{
  auto options = receiver_options();
  options.retry_interval = 10ms;
  std::atomic<int> changes{0};
  StateReceiver receiver(options, log.function());
  receiver.on_link([&](const LinkStatus &) { ++changes; });
  receiver.start();
  ASSERT_TRUE(eventually([&] { return log.count(own_address() + ":30004") > 0; }));
  Sample none{};
  EXPECT_FALSE(receiver.wait_for_next(none, 200ms));  // some twenty more tries
  EXPECT_EQ(log.count(own_address() + ":30004"), 1U) << log.text();
  EXPECT_EQ(log.count("Trying again after at most 0.01 s"), 1U) << log.text();
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(receiver.link().error.code, ErrorCode::link_lost);
}

TEST_F(StateReceiverConnectionTest, DetectsAServiceThatNeverAnswers)
{
  const OtherService silent(30004, "");
  const auto receiver = this->receiver();
  EXPECT_TRUE(eventually([&] { return log.count("does not answer as the RTDE server") == 1; })) << log.text();
}

TEST_F(StateReceiverConnectionTest, DetectsAnotherService)
{
  const OtherService secure_shell(30004, "SSH-2.0-OpenSSH_9.2p1 Debian-2+deb12u3\r\n");
  const auto receiver = this->receiver();
  EXPECT_TRUE(eventually([&] { return log.count("not an RTDE package") == 1; })) << log.text();
  EXPECT_FALSE(receiver->link().connected);
}

TEST_F(StateReceiverConnectionTest, ConnectsToTheControllerAfterAnotherServiceAtItsAddress)
{
  auto other = std::make_unique<OtherService>(30004, "HTTP/1.1 400 Bad Request\r\n\r\n");
  const auto receiver = this->receiver();
  ASSERT_TRUE(eventually([&] { return log.count("not an RTDE package") == 1; })) << log.text();
  other.reset();
  controller.start();
  EXPECT_TRUE(connected(*receiver)) << log.text();
}

TEST_F(StateReceiverConnectionTest, ReconnectsAfterARestartOfTheController)
{
  controller.start();
  const auto receiver = this->receiver();
  ASSERT_TRUE(connected(*receiver));
  controller.stop();
  ASSERT_TRUE(eventually([&] { return !receiver->link().connected; }));
  const auto last = receiver->latest();
  ASSERT_TRUE(last) << "the last sample is kept";
  controller.start();
  const auto returned = Clock::now();
  ASSERT_TRUE(connected(*receiver)) << log.text();
  RecordProperty(
      "reconnected_after_ms",
      std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - returned).count()));
  EXPECT_EQ(receiver->latest()->link, 2U);
  EXPECT_GT(receiver->latest()->sequence, last->sequence);
}

TEST_F(StateReceiverConnectionTest, ReplacesALostConnectionAtOnce)
{
  controller.start();
  auto options = receiver_options();
  options.retry_interval = 400ms;
  const auto receiver = this->receiver(options);
  auto shortest = Clock::duration::max();
  for (std::uint32_t link = 1; link <= 3; ++link) {
    ASSERT_TRUE(eventually([&] { return receiver->latest() && receiver->latest()->link == link; }))
        << log.text();
    const auto begin = receiver->latest()->received;
    // Connections that break sooner are replaced at the retry interval.
    ASSERT_TRUE(
        eventually([&] { return receiver->latest()->received > begin + 2 * options.retry_interval; }));
    controller.control({{"command", "drop_links"}, {"which", "rtde"}});
    Sample last = *receiver->latest();
    while (last.link == link) {
      const auto received = last.received;
      ASSERT_TRUE(receiver->wait_for_next(last, 5s)) << log.text();
      shortest = last.link == link ? shortest : std::min(shortest, last.received - received);
    }
  }
  RecordProperty("interruption_us",
                 std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(shortest).count()));
  EXPECT_LT(shortest, options.retry_interval / 2);
  EXPECT_EQ(log.count("closed the RTDE connection; connected again"), 3U) << log.text();
}

TEST_F(StateReceiverConnectionTest, ConnectsSoonAfterTheControllerHasStarted)
{
  auto options = receiver_options();
  options.retry_interval = 30s;  // the delay is 1 % of the outage
  auto shortest = Clock::duration::max();
  for (int i = 0; i < 3; ++i) {
    const auto receiver = this->receiver(options);
    ASSERT_FALSE(eventually([&] { return receiver->link().connected; }, 200ms));
    controller.start();
    const auto started = Clock::now();
    ASSERT_TRUE(connected(*receiver)) << log.text();
    shortest = std::min(shortest, Clock::now() - started);
    controller.stop();
  }
  RecordProperty("connected_after_us",
                 std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(shortest).count()));
  EXPECT_LT(shortest, 1s);
}

TEST_F(StateReceiverConnectionTest, DetectsClosedAndResetConnections)
{
  controller.start();
  const auto receiver = this->receiver();
  for (const bool reset : {false, true}) {
    ASSERT_TRUE(connected(*receiver)) << log.text();
    const auto link = receiver->latest()->link;
    controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"reset", reset}});
    EXPECT_TRUE(eventually([&] { return receiver->latest()->link > link; })) << log.text();
  }
}

TEST_F(StateReceiverConnectionTest, DetectsAHalfOpenConnectionByMissingPackages)
{
  controller.start();
  auto options = receiver_options();
  options.silence_limit = StateReceiverOptions().silence_limit;
  const auto receiver = this->receiver(options);
  ASSERT_TRUE(connected(*receiver));
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return !receiver->link().connected; }));
  const auto silence = std::chrono::duration<double>(Clock::now() - receiver->latest()->received).count();
  RecordProperty("half_open_noticed_after_ms", std::to_string(1000.0 * silence));
  EXPECT_GT(silence, 0.1);
  EXPECT_LT(silence, 2.0) << "100 ms plus the delay of a busy host";
  EXPECT_TRUE(eventually([&] { return log.count("no RTDE package from " + own_address()) == 1; }))
      << log.text();
  controller.control({{"command", "stall_links"}, {"which", "rtde"}, {"stalled", false}});
  EXPECT_TRUE(connected(*receiver)) << log.text();
}

TEST_F(StateReceiverConnectionTest, DoesNotMistakeADelayOfThisHostForSilence)
{
  controller.start();
  auto options = receiver_options();
  options.silence_limit = StateReceiverOptions().silence_limit;
  StateReceiver receiver(options, log.function());
  std::promise<void> go_on;
  constexpr std::uint64_t held_sample = 10;  // received by ur_rtde's thread, unlike the first one
  receiver.on_sample([wait = go_on.get_future().share()](const Sample & sample) {
    if (sample.sequence == held_sample) {
      wait.wait();
    }
  });
  receiver.start();
  ASSERT_TRUE(eventually([&] {
    const auto latest = receiver.latest();
    return latest && latest->sequence == held_sample;
  })) << log.text();
  Sample sample = *receiver.latest();
  EXPECT_FALSE(receiver.wait_for_next(sample, 3 * options.silence_limit)) << "the packages are not processed";
  EXPECT_TRUE(receiver.link().connected) << log.text();
  go_on.set_value();
  EXPECT_TRUE(receiver.wait_for_next(sample, 5s)) << log.text();
  EXPECT_EQ(sample.link, 1U) << log.text();
}

TEST_F(StateReceiverConnectionTest, GivesTheControllerTheWholeLimitAfterASuspensionOfThisProcess)
{
  controller.start();
  auto options = receiver_options();
  options.silence_limit = 1s;  // and less than ur_rtde's own timeout of 2.5 s together with the suspension
  std::promise<Clock::time_point> lost;
  StateReceiver receiver(options, log.function());
  receiver.on_link([&, first = true](const LinkStatus & status) mutable {
    if (!status.connected && std::exchange(first, false)) {
      lost.set_value(Clock::now());
    }
  });
  receiver.start();
  ASSERT_TRUE(connected(receiver)) << log.text();
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});  // not that of the next connection
  const auto stalled = Clock::now();
  ASSERT_EQ(std::system("kill -STOP $PPID; sleep 1.1; kill -CONT $PPID"), 0);
  auto lost_at = lost.get_future();
  ASSERT_EQ(lost_at.wait_for(15s), std::future_status::ready);
  EXPECT_GT(lost_at.get() - stalled, 1100ms + options.silence_limit / 2) << log.text();
}

TEST_F(StateReceiverConnectionTest, ReconnectsAfterAnExceptionInACallback)
{
  controller.start();
  StateReceiver receiver(receiver_options(), log.function());
  receiver.on_sample([thrown = false](const Sample & sample) mutable {
    if (sample.sequence > 20 && !std::exchange(thrown, true)) {
      throw std::runtime_error("the disk is full");
    }
  });
  receiver.start();
  ASSERT_TRUE(eventually([&] { return receiver.latest() && receiver.latest()->link == 2; })) << log.text();
  EXPECT_EQ(log.count("a callback could not process a package: the disk is full"), 1U) << log.text();
  EXPECT_TRUE(connected(receiver)) << log.text();
}

TEST_F(StateReceiverConnectionTest, HasASampleOfTheConnectionWhenItReportsTheConnection)
{
  controller.start();
  StateReceiver receiver(receiver_options(), log.function());
  std::mutex mutex;
  std::vector<std::uint32_t> links;
  receiver.on_link([&](const LinkStatus & status) {
    if (status.connected) {
      const auto sample = receiver.latest();
      const std::lock_guard lock(mutex);
      links.push_back(sample ? sample->link : 0U);
    }
  });
  const auto connections = [&] {
    const std::lock_guard lock(mutex);
    return links;
  };
  receiver.start();
  ASSERT_TRUE(eventually([&] { return connections().size() == 1; })) << log.text();
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return connections().size() == 2; })) << log.text();
  EXPECT_EQ(connections(), (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(StateReceiverConnectionTest, SurvivesGarbage)
{
  controller.start();
  const auto receiver = this->receiver();
  for (const int bytes : {1, 3, 64, 5000}) {
    ASSERT_TRUE(connected(*receiver)) << log.text();
    const auto sequence = receiver->latest()->sequence;
    controller.control({{"command", "send_garbage"}, {"which", "rtde"}, {"bytes", bytes}});
    EXPECT_TRUE(eventually([&] {
      return receiver->link().connected && receiver->latest()->sequence > sequence + 100;
    })) << bytes
        << " bytes\n"
        << log.text();
  }
}

TEST_F(StateReceiverConnectionTest, DoesNotLeakOverManyReconnections)
{
  controller.start();
  auto options = receiver_options();
  options.retry_interval = 1ms;
  const auto receiver = this->receiver(options);
  std::size_t descriptors = 0;
  std::size_t threads = 0;
  for (int round = 0; round < 30; ++round) {
    ASSERT_TRUE(eventually([&] {
      return receiver->link().connected && receiver->latest()->link > static_cast<unsigned>(round);
    })) << log.text();
    if (round == 5) {
      descriptors = open_descriptors();
      threads = running_threads();
    }
    if (round > 5) {
      // The simulator closes its sockets a little later.
      EXPECT_TRUE(eventually([&] { return open_descriptors() <= descriptors + 2; }))
          << open_descriptors() << " of " << descriptors;
      EXPECT_TRUE(eventually([&] { return running_threads() <= threads; }))
          << running_threads() << " of " << threads;
    }
    controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  }
}

}  // namespace
}  // namespace ur_ros_rtde::test
