#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <rcl_cxx/subscription.hpp>
#include <string>
#include <thread>

#include "teleoperation/teleop_reports.hpp"
#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// A topic that moves the arm, with a thread of its own. A session starts with the first message after a
/// pause of `timeout` and acquires Resource::motion; it is rejected if another goal or topic holds it. The
/// session ends without messages for `timeout`, with an invalid message, when it is preempted, and when the
/// robot stops. Then the arm decelerates to standstill, and messages are ignored until there has been a pause
/// of `timeout`; unless the messages had ended, the publisher itself has to pause (has_paused), a delay on
/// the way or of this host is not enough. A publisher whose last message before the pause commanded a motion,
/// or that was stopped since, was interrupted, and one that was there before this object, or beside the one
/// that was stopped, has begun without it: neither a hung program that goes on nor a restarted driver may
/// move the arm. Their next session starts with a message that commands no motion (TargetFollower::moves).
/// The start and the end of each session are reported once.
class TeleopTopic {
 public:
  /// `topic` is the resolved name: "/servo_joint". `host` outlives this object.
  TeleopTopic(std::string topic, CommandHost & host, const StreamOptions & options,
              std::unique_ptr<TargetFollower> follower, const LogFunction & log,
              TeleopReports::Publish publish);
  /// Ends the session and joins the thread.
  ~TeleopTopic();
  TeleopTopic(const TeleopTopic &) = delete;
  TeleopTopic & operator=(const TeleopTopic &) = delete;

  /// Called with the target of each message, or with the reason why it is invalid. Does not wait.
  void on_message(Expected<StreamTarget> target, const rcl_cxx::MessageInfo & info);
  /// Tells the session to end, if there is one, and starts no other. Returns at once.
  void stop(const Error & why);
  /// Calls stop() and joins the thread.
  void close();

 private:
  using Clock = std::chrono::steady_clock;

  /// Why a session waits for a message that commands no motion.
  enum class Hindrance {
    none,
    gap,        ///< in the messages, after one that commanded a motion or was stopped
    publisher,  ///< may be an old one, whose messages did not arrive
    stop,       ///< while the session waited: the publisher has to pause
  };

  /// Messages that follow each other.
  struct Session {
    std::uint64_t number = 0;
    std::uint32_t stops = 0;           ///< CommandHost::stops() when it could begin
    rcl_cxx::MessageInfo first;        ///< of its first message
    Clock::time_point silent_since{};  ///< there were no messages before it
    bool follows_pause = false;        ///< of the publisher (has_paused)
    bool needs_pause = false;          ///< the next session: this one did not end for lack of messages
    Hindrance hindrance{};             ///< unless it has been started
    bool is_reported = false;          ///< its hindrance
    bool may_start() const { return number > 0 && hindrance == Hindrance::none; }
  };

  struct Message {
    Expected<StreamTarget> target = StreamTarget{};
    Clock::time_point arrived{};
    std::uint64_t number = 0;
    TargetPeriod period{};  ///< between messages
    rcl_cxx::MessageInfo info;
    bool moves = false;  ///< commands a motion
    Session session;     ///< that it belongs to
  };

  /// Time from a message to its first command.
  struct Latency {
    void add(Clock::duration wait);
    std::string text() const;
    std::uint64_t count = 0;
    Clock::duration sum{}, longest{};
  };

  /// The message that follows the newest one.
  Message following(Expected<StreamTarget> target, const rcl_cxx::MessageInfo & info,
                    const std::optional<Sample> & sample) const;
  Hindrance hindrance_of_first(const Message & next, bool was_stopped) const;
  Hindrance hindrance_of_following(const Message & next, bool was_stopped) const;
  /// Messages may still show that the publisher is a new one, whose first messages were lost.
  bool is_known(const Message & message) const;
  void serve(const std::stop_token & stop);
  /// After the end of this session, which this publisher began, not for lack of messages. Returns the newest
  /// session that must not start.
  std::uint64_t require_pause(std::uint64_t session, const rcl_cxx::PublisherId & publisher);
  Outcome run_session(std::uint64_t session, Latency & latency);
  /// Tells the session of `lease` to end; the arm stops without waiting for its thread.
  void end_session(const Error & why);
  /// Sends commands until there is a reason to end the session, which it returns.
  Error follow(Run & run, std::uint64_t session, Latency & latency);
  Status check_timeout(const Message & message, std::uint64_t session) const;
  Status set_target(TargetStream & stream, const Message & message, std::uint64_t session) const;
  /// Stops the arm. The outcome has the reason, and whether standstill is confirmed.
  /// Without further messages, a mode that was active before goes on, as after a motion that succeeds.
  Outcome settle(const Error & why, Activities active_before) const;
  Message newest() const;
  void report(Hindrance hindrance) const;

  const std::string topic_;
  CommandHost & host_;
  const StreamOptions options_;
  const std::unique_ptr<TargetFollower> follower_;
  const TeleopReports reports_;
  const Clock::time_point created_ = Clock::now();

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Message newest_;
  std::shared_ptr<StopRequest> stop_request_;  ///< of the current session
  Lease lease_;                                ///< likewise
  bool closed_ = false;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
