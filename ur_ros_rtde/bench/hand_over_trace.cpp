// A library for LD_PRELOAD: records when a process hands packages, messages and requests over from one part
// to the next, without a change of its code. Writes one line per event to the file that HAND_OVER_TRACE
// names, in the destructor: kind, thread, time in ns since the epoch, stamp of the message in ns or 0.
// `./ur bench --trace` uses it; tools/ur_tools/bench_hand_overs.py evaluates the file.
#include <dlfcn.h>
#include <poll.h>
#include <rmw/rmw.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

namespace {

constexpr std::string_view traced_topic = "/joint_states";

struct Event {
  const char * kind;
  std::int64_t time;
  std::int64_t stamp;
  int thread;
};

class Trace {
 public:
  Trace() : file_(std::getenv("HAND_OVER_TRACE")) {}
  ~Trace();
  Trace(const Trace &) = delete;
  Trace & operator=(const Trace &) = delete;

  /// Does not allocate or lock. Events beyond the capacity are dropped.
  void add(const char * kind, std::int64_t stamp = 0)
  {
    const std::size_t index = file_ == nullptr ? events_.size() : count_++;
    if (index < events_.size()) {
      thread_local const int thread = ::gettid();
      const auto now = std::chrono::system_clock::now().time_since_epoch();
      events_[index] = {kind, std::chrono::nanoseconds(now).count(), stamp, thread};
    }
  }

 private:
  const char * const file_;
  std::atomic<std::size_t> count_{0};
  std::array<Event, 1 << 18> events_{};
};

Trace::~Trace()
{
  std::FILE * const file = file_ == nullptr ? nullptr : std::fopen(file_, "w");
  if (file == nullptr) {
    return;
  }
  for (std::size_t i = 0; i < std::min(count_.load(), events_.size()); ++i) {
    const Event & event = events_[i];
    std::fprintf(file, "%s %d %lld %lld\n", event.kind, event.thread, static_cast<long long>(event.time),
                 static_cast<long long>(event.stamp));
  }
  std::fclose(file);
}

Trace trace;

template <typename Function>
Function * next(const char * name)
{
  return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name));
}

/// The time stamp of a message that begins with a std_msgs/Header.
std::int64_t stamp_of(const void * message)
{
  struct Stamp {
    std::int32_t sec;
    std::uint32_t nanosec;
  };
  const auto & stamp = *static_cast<const Stamp *>(message);
  return std::int64_t{stamp.sec} * 1'000'000'000 + stamp.nanosec;
}

bool is_traced(const char * topic)
{
  return topic != nullptr && topic == traced_topic;
}

/// Replaces the callback of a subscription or of a service by one that also records an event.
struct Callback {
  const char * kind;
  rmw_event_callback_t function;
  const void * data;

  static void run(const void * self, std::size_t count)
  {
    const auto & callback = *static_cast<const Callback *>(self);
    trace.add(callback.kind);
    callback.function(callback.data, count);
  }
};

const Callback * keep_callback(const void * entity, Callback callback)
{
  static std::mutex mutex;
  static std::map<const void *, Callback> callbacks;
  const std::lock_guard lock(mutex);
  return &callbacks.insert_or_assign(entity, callback).first->second;
}

}  // namespace

extern "C" {

int poll(pollfd * descriptors, nfds_t count, int timeout)
{
  static const auto original = next<decltype(poll)>("poll");
  const int result = original(descriptors, count, timeout);
  if (result > 0) {
    trace.add("readable");
  }
  return result;
}

ssize_t recv(int descriptor, void * buffer, std::size_t size, int flags)
{
  static const auto original = next<decltype(recv)>("recv");
  const ssize_t result = original(descriptor, buffer, size, flags);
  trace.add("received");
  return result;
}

ssize_t send(int descriptor, const void * buffer, std::size_t size, int flags)
{
  static const auto original = next<decltype(send)>("send");
  trace.add("send");
  return original(descriptor, buffer, size, flags);
}

rmw_ret_t rmw_publish(const rmw_publisher_t * publisher, const void * message,
                      rmw_publisher_allocation_t * allocation)
{
  static const auto original = next<decltype(rmw_publish)>("rmw_publish");
  if (!is_traced(publisher->topic_name)) {
    return original(publisher, message, allocation);
  }
  const std::int64_t stamp = stamp_of(message);
  trace.add("publish", stamp);
  const rmw_ret_t result = original(publisher, message, allocation);
  trace.add("published", stamp);
  return result;
}

rmw_ret_t rmw_take_with_info(const rmw_subscription_t * subscription, void * message, bool * taken,
                             rmw_message_info_t * info, rmw_subscription_allocation_t * allocation)
{
  static const auto original = next<decltype(rmw_take_with_info)>("rmw_take_with_info");
  const rmw_ret_t result = original(subscription, message, taken, info, allocation);
  if (is_traced(subscription->topic_name) && result == RMW_RET_OK && *taken) {
    trace.add("taken", stamp_of(message));
  }
  return result;
}

rmw_ret_t rmw_subscription_set_on_new_message_callback(rmw_subscription_t * subscription,
                                                       rmw_event_callback_t callback, const void * data)
{
  static const auto original = next<decltype(rmw_subscription_set_on_new_message_callback)>(
      "rmw_subscription_set_on_new_message_callback");
  if (callback == nullptr || !is_traced(subscription->topic_name)) {
    return original(subscription, callback, data);
  }
  return original(subscription, &Callback::run, keep_callback(subscription, {"notified", callback, data}));
}

rmw_ret_t rmw_service_set_on_new_request_callback(rmw_service_t * service, rmw_event_callback_t callback,
                                                  const void * data)
{
  static const auto original =
      next<decltype(rmw_service_set_on_new_request_callback)>("rmw_service_set_on_new_request_callback");
  if (callback == nullptr) {
    return original(service, callback, data);
  }
  return original(service, &Callback::run, keep_callback(service, {"request_notified", callback, data}));
}

rmw_ret_t rmw_take_request(const rmw_service_t * service, rmw_service_info_t * info, void * request,
                           bool * taken)
{
  static const auto original = next<decltype(rmw_take_request)>("rmw_take_request");
  const rmw_ret_t result = original(service, info, request, taken);
  trace.add("request_taken");
  return result;
}

rmw_ret_t rmw_send_response(const rmw_service_t * service, rmw_request_id_t * request, void * response)
{
  static const auto original = next<decltype(rmw_send_response)>("rmw_send_response");
  trace.add("respond");
  const rmw_ret_t result = original(service, request, response);
  trace.add("responded");
  return result;
}
}
