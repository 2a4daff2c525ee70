#include "state/field_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "state/state_messages.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = RtdeSubscription::Clock;

constexpr std::chrono::milliseconds fields_retry_interval{500};
/// Interval at which the subscribers of tool_data are counted.
constexpr std::chrono::milliseconds fields_poll_interval{100};
constexpr std::chrono::milliseconds min_silence_limit{1000};
/// After a field was found missing: another controller, or an update, may have it.
constexpr std::chrono::seconds unavailable_fields_interval{10};

/// The RTDE fields of ToolData, in the order in which publish_tool() reads them.
const std::array<std::string, 10> tool_fields{"tool_analog_input0",
                                              "tool_analog_input1",
                                              "tool_analog_input_types",
                                              "tool_output_voltage",
                                              "tool_output_current",
                                              "tool_temperature",
                                              "tool_mode",
                                              "actual_digital_input_bits",
                                              "actual_digital_output_bits",
                                              "actual_tool_accelerometer"};
constexpr unsigned first_tool_pin = 16;

bool bit(double word, unsigned number)
{
  return (static_cast<std::uint64_t>(word) >> number & 1U) != 0;
}

std::vector<std::string> recipe(const std::vector<std::string> & wanted, bool with_tool)
{
  std::vector<std::string> fields;
  if (with_tool) {
    fields.assign(tool_fields.begin(), tool_fields.end());
  }
  std::ranges::copy_if(wanted, std::back_inserter(fields), [&](const std::string & name) {
    return std::ranges::find(fields, name) == fields.end();
  });
  return fields;
}

void wait(const std::stop_token & stop, std::chrono::milliseconds duration)
{
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any().wait_for(lock, stop, duration, [] { return false; });
}
}  // namespace

FieldTopics::FieldTopics(rcl_cxx::Node & node, Options options, LogFunction log)
    : options_(std::move(options)), logger_(std::move(log))
{
  const rcl_cxx::QoS qos = rcl_cxx::QoS::from_name(options_.qos);
  tool_.header.frame_id = options_.tf_prefix + "tool0";
  tool_data_ = node.create_publisher<ur_ros_rtde_msgs::msg::ToolData>("tool_data", qos);
  if (!options_.fields.empty()) {
    robot_state_ = node.create_publisher<ur_ros_rtde_msgs::msg::RobotState>("robot_state", qos);
  }
  thread_ = std::jthread([this](const std::stop_token & stop) { run(stop); });
}

void FieldTopics::run(const std::stop_token & stop)
{
  Clock::time_point without_fields_until;  // tool_data goes on without fields that this controller lacks
  while (!stop.stop_requested()) {
    const bool with_tool = tool_wanted();
    const bool with_fields = !options_.fields.empty() && Clock::now() >= without_fields_until;
    if (!with_tool && !with_fields) {
      wait(stop, fields_poll_interval);
      continue;
    }
    const auto fields = with_fields ? options_.fields : std::vector<std::string>();
    auto subscription =
        RtdeSubscription::open(options_.address, recipe(fields, with_tool), options_.frequency);
    if (subscription && (with_fields || options_.fields.empty())) {
      logger_.reset();
    }
    const Status ended =
        subscription ? follow(*subscription, with_tool, stop) : tl::unexpected(subscription.error());
    if (ended || stop.stop_requested()) {
      continue;
    }
    logger_.log_on_change(LogLevel::error,
                          fmt::format("tool_data and robot_state: {}; trying again", ended.error().message));
    if (with_fields && ended.error().code == ErrorCode::not_supported) {
      without_fields_until = Clock::now() + unavailable_fields_interval;
    } else {
      without_fields_until = {};
      wait(stop, fields_retry_interval);
    }
  }
}

/// Publishes until the need for tool_data changes, a stop is requested or the connection fails.
Status FieldTopics::follow(RtdeSubscription & subscription, bool with_tool, const std::stop_token & stop)
{
  set_up_fields(subscription);
  std::vector<double> numbers(subscription.width());
  const auto silence_limit = subscription.silence_limit(min_silence_limit);
  auto last = Clock::now();
  auto next_poll = last + fields_poll_interval;
  while (!stop.stop_requested()) {
    const auto got = subscription.next(numbers, Clock::now() + fields_poll_interval);
    if (!got) {
      return tl::unexpected(got.error());
    }
    const auto now = Clock::now();
    if (*got) {
      last = now;
      if (with_tool) {
        publish_tool(numbers);
      }
      if (!begins_.empty()) {
        publish_state(numbers);
      }
    } else if (now - last > silence_limit) {
      return failure(ErrorCode::link_lost, fmt::format("{} has stopped sending data", options_.address));
    }
    if (now >= next_poll) {
      next_poll = now + fields_poll_interval;
      if (tool_wanted() != with_tool) {
        return {};
      }
    }
  }
  return {};
}

void FieldTopics::set_up_fields(const RtdeSubscription & subscription)
{
  state_.fields.clear();
  begins_.clear();
  for (const std::string & name : options_.fields) {
    std::size_t begin = 0;
    for (const RtdeSubscription::Field & field : subscription.fields()) {
      if (field.name == name) {
        begins_.push_back(begin);
        state_.fields.emplace_back();
        state_.fields.back().name = name;
        state_.fields.back().values.resize(field.size);
      }
      begin += field.size;
    }
  }
}

void FieldTopics::publish_tool(std::span<const double> numbers)
{
  tool_.header.stamp = to_time(std::chrono::system_clock::now());
  for (unsigned i = 0; i < 2; ++i) {
    tool_.analog_inputs[i] = numbers[i];
    tool_.analog_input_modes[i] = bit(numbers[2], i) ? 1 : 0;
    tool_.digital_inputs[i] = bit(numbers[7], first_tool_pin + i);
    tool_.digital_outputs[i] = bit(numbers[8], first_tool_pin + i);
  }
  tool_.output_voltage = numbers[3];
  tool_.output_current = numbers[4];
  tool_.temperature = numbers[5];
  tool_.mode = static_cast<std::uint8_t>(numbers[6]);
  tool_.acceleration.x = numbers[9];
  tool_.acceleration.y = numbers[10];
  tool_.acceleration.z = numbers[11];
  tool_data_->publish(tool_);
}

void FieldTopics::publish_state(std::span<const double> numbers)
{
  state_.header.stamp = to_time(std::chrono::system_clock::now());
  for (std::size_t i = 0; i < begins_.size(); ++i) {
    auto & values = state_.fields[i].values;
    std::ranges::copy(numbers.subspan(begins_[i], values.size()), values.begin());
  }
  robot_state_->publish(state_);
}

}  // namespace ur_ros_rtde
