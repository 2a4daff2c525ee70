// Sends goals of set_payload with nothing but rcl, and prints for each when it was sent: ns since the epoch,
// by the host's clock.
#include <rcl/graph.h>
#include <time.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <rosidl_typesupport_cpp/service_type_support.hpp>
#include <ur_ros_rtde_msgs/action/set_payload.hpp>

#include "bare_node.hpp"

namespace {

using bench::check;
using bench::fail;
using ur_ros_rtde_msgs::action::SetPayload;
using SendGoal = SetPayload::Impl::SendGoalService;
using GetResult = SetPayload::Impl::GetResultService;
constexpr std::int64_t second = 1'000'000'000;  // ns
constexpr std::int64_t discovery_limit = 15 * second;
constexpr std::int64_t response_limit = 30 * second;
/// Between two goals, so that the control program waits for a command again, at any phase of its cycle.
constexpr long pause = 20'000'000;
constexpr long spread = 2'000'000;

std::int64_t now()
{
  timespec time;
  clock_gettime(CLOCK_REALTIME, &time);
  return time.tv_sec * second + time.tv_nsec;
}

void sleep_for(long nanoseconds)
{
  const timespec time{0, nanoseconds};
  nanosleep(&time, nullptr);
}

/// A client of one of the services of an action.
template <typename Service>
class Client {
 public:
  Client(bench::BareNode & bare, const char * name) : node_(bare.node)
  {
    const rcl_client_options_t options = rcl_client_get_default_options();
    check(rcl_client_init(&client_, &node_,
                          rosidl_typesupport_cpp::get_service_type_support_handle<Service>(), name,
                          &options));
    rcl_reset_error();  // the type support for another language was tried first
    check(rcl_wait_set_init(&wait_set_, 0, 0, 0, 1, 0, 0, &bare.context, rcl_get_default_allocator()));
  }
  ~Client()
  {
    check(rcl_wait_set_fini(&wait_set_));
    check(rcl_client_fini(&client_, &node_));
  }
  Client(const Client &) = delete;
  Client & operator=(const Client &) = delete;

  void wait_for_service()
  {
    bool available = false;
    for (const auto end = now() + discovery_limit; !available;) {
      check(rcl_service_server_is_available(&node_, &client_, &available));
      if (!available && now() > end) {
        fail("set_payload was not found within 15 s");
      }
      sleep_for(available ? 0 : pause);
    }
  }

  void send(const typename Service::Request & request)
  {
    std::int64_t number = 0;
    check(rcl_send_request(&client_, &request, &number));
  }

  typename Service::Response receive()
  {
    check(rcl_wait_set_clear(&wait_set_));
    check(rcl_wait_set_add_client(&wait_set_, &client_, nullptr));
    check(rcl_wait(&wait_set_, response_limit));
    rmw_request_id_t id{};
    typename Service::Response response;
    check(rcl_take_response(&client_, &id, &response));
    return response;
  }

 private:
  rcl_node_t & node_;
  rcl_client_t client_ = rcl_get_zero_initialized_client();
  rcl_wait_set_t wait_set_ = rcl_get_zero_initialized_wait_set();
};

SendGoal::Request make_request(int number)
{
  SendGoal::Request request;
  const std::int64_t unique = now();
  for (std::size_t i = 0; i < sizeof(unique); ++i) {
    request.goal_id.uuid[i] = static_cast<std::uint8_t>(unique >> (8 * i));
  }
  request.goal.mass = 0.5 + 0.01 * (number % 10);
  return request;
}

/// The subscription by which the driver knows a client of an action.
class Feedback {
 public:
  explicit Feedback(bench::BareNode & node) : node_(node.node)
  {
    const auto * const type =
        rosidl_typesupport_cpp::get_message_type_support_handle<SetPayload::Impl::FeedbackMessage>();
    const rcl_subscription_options_t options = rcl_subscription_get_default_options();
    check(rcl_subscription_init(&subscription_, &node_, type, "set_payload/_action/feedback", &options));
    rcl_reset_error();  // as in Client
  }
  ~Feedback() { check(rcl_subscription_fini(&subscription_, &node_)); }
  Feedback(const Feedback &) = delete;
  Feedback & operator=(const Feedback &) = delete;

 private:
  rcl_node_t & node_;
  rcl_subscription_t subscription_ = rcl_get_zero_initialized_subscription();
};

void send_goals(bench::BareNode & node, int count)
{
  const Feedback feedback(node);
  Client<SendGoal> goals(node, "set_payload/_action/send_goal");
  Client<GetResult> results(node, "set_payload/_action/get_result");
  goals.wait_for_service();
  results.wait_for_service();
  for (int i = 0; i < count; ++i) {
    const SendGoal::Request request = make_request(i);
    const std::int64_t sent = now();
    goals.send(request);
    if (!goals.receive().accepted) {
      fail("a goal was rejected; see the topic goal_rejections");
    }
    GetResult::Request result;
    result.goal_id = request.goal_id;
    results.send(result);
    results.receive();
    std::printf("%lld\n", static_cast<long long>(sent));
    sleep_for(pause + static_cast<long>(sent % spread));
  }
}

}  // namespace

int main(int argc, char ** argv)
{
  const int count = argc > 1 ? std::atoi(argv[1]) : 0;
  if (count < 1 || count > 100'000) {
    std::fprintf(stderr, "usage: goal_latency GOALS (1 to 100000)\n");
    return 2;
  }
  bench::BareNode node("goal_latency", "");
  send_goals(node, count);
  return 0;
}
