// Publishes joint_states at 500 Hz with nothing but rcl, so that the time from publishing to a subscriber can
// be compared with that of the driver. The stamp of a message is the time just before it is published.
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <sensor_msgs/msg/joint_state.hpp>

#include "bare_node.hpp"

namespace {

using bench::check;
using sensor_msgs::msg::JointState;
constexpr long period = 2'000'000;  // ns
constexpr long second = 1'000'000'000;

JointState make_message()
{
  JointState message;
  message.name = {"shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
                  "wrist_1_joint",      "wrist_2_joint",       "wrist_3_joint"};
  for (auto * values : {&message.position, &message.velocity, &message.effort}) {
    values->assign(message.name.size(), 1.0);
  }
  return message;
}

void publish(const rcl_publisher_t & publisher, int count)
{
  JointState message = make_message();
  timespec due;
  clock_gettime(CLOCK_MONOTONIC, &due);
  for (int i = 0; i < count; ++i) {
    due.tv_nsec += period;
    due.tv_sec += due.tv_nsec / second;
    due.tv_nsec %= second;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    message.header.stamp.sec = static_cast<std::int32_t>(now.tv_sec);
    message.header.stamp.nanosec = static_cast<std::uint32_t>(now.tv_nsec);
    check(rcl_publish(&publisher, &message, nullptr));
  }
}

}  // namespace

int main(int argc, char ** argv)
{
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 0;
  if (seconds < 1 || seconds > 600) {
    std::fprintf(stderr, "usage: joint_state_floor SECONDS (1 to 600)\n");
    return 2;
  }
  bench::BareNode bare("joint_state_floor", "/floor");
  rcl_publisher_t publisher = rcl_get_zero_initialized_publisher();
  rcl_publisher_options_t publisher_options = rcl_publisher_get_default_options();
  publisher_options.qos = rmw_qos_profile_sensor_data;
  check(rcl_publisher_init(&publisher, &bare.node,
                           rosidl_typesupport_cpp::get_message_type_support_handle<JointState>(),
                           "joint_states", &publisher_options));
  publish(publisher, seconds * static_cast<int>(second / period));
  check(rcl_publisher_fini(&publisher, &bare.node));
  return 0;
}
