#include "process/duplicate_check.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <string_view>
#include <tuple>
#include <utility>

namespace ur_ros_rtde {
namespace {
/// Longest time for discovery. After that, this process is in use and must not exit.
constexpr std::chrono::seconds start_phase{10};
/// Begins the message of a process that runs for longer, which the clocks of both hosts may not tell.
constexpr std::string_view is_running = "running: ";
constexpr const char * remedy =
    "stop one of them, or use a different namespace (--ros-args -r __ns:=/…) or ROS_DOMAIN_ID";

std_msgs::msg::Header this_process()
{
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(now);
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  std_msgs::msg::Header header;
  header.stamp.sec = static_cast<std::int32_t>(whole.count());
  header.stamp.nanosec = static_cast<std::uint32_t>(std::chrono::nanoseconds(now - whole).count());
  header.frame_id = fmt::format("process {} on {}", ::getpid(), host.data());
  return header;
}

auto age(const std_msgs::msg::Header & header)
{
  return std::tie(header.stamp.sec, header.stamp.nanosec, header.frame_id);
}
}  // namespace

DuplicateCheck::DuplicateCheck(rcl_cxx::Node & node, std::function<void(const std::string & why)> reject)
    : node_(node),
      reject_(std::move(reject)),
      own_(this_process()),
      publisher_(node.create_publisher<Instance>("~/_instance", rcl_cxx::QoS::transient_local())),
      subscription_(
          node.create_subscription<Instance>("~/_instance", rcl_cxx::QoS::transient_local(8),
                                             [this](const Instance & other) { on_instance(other); }))
{
  publisher_->publish(own_);
}

std::optional<std::string> DuplicateCheck::find_older()
{
  for (Instance other; subscription_->take(other);) {
    if (is_older(other)) {
      return rejection(other);
    }
  }
  return std::nullopt;
}

void DuplicateCheck::on_instance(const Instance & other)
{
  if (is_own(other)) {
    return;
  }
  if (std::chrono::steady_clock::now() - begin_ <= start_phase) {
    if (is_older(other)) {
      reject_(rejection(other));
    }
    return;
  }
  RCL_CXX_ERROR(node_.get_logger(), "{}; both answer the same clients: {}", conflict_with(other), remedy);
  if (!other.frame_id.starts_with(is_running)) {  // otherwise it knows
    publisher_->publish(own_running());
  }
}

DuplicateCheck::Instance DuplicateCheck::own_running() const
{
  Instance running = own_;
  running.frame_id = fmt::format("{}{}", is_running, own_.frame_id);
  return running;
}

bool DuplicateCheck::is_own(const Instance & other) const
{
  return age(other) == age(own_) || age(other) == age(own_running());
}

bool DuplicateCheck::is_older(const Instance & other) const
{
  return !is_own(other) && (other.frame_id.starts_with(is_running) || age(other) < age(own_));
}

std::string DuplicateCheck::conflict_with(const Instance & other) const
{
  return fmt::format(
      "another node with the name {} is already running ({})", node_.get_fully_qualified_name(),
      other.frame_id.starts_with(is_running) ? other.frame_id.substr(is_running.size()) : other.frame_id);
}

std::string DuplicateCheck::rejection(const Instance & other) const
{
  return fmt::format("{}, so this process exits: {}", conflict_with(other), remedy);
}

}  // namespace ur_ros_rtde
