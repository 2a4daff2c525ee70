#include "nodes/robot_state_receiver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nodes/node_log.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = std::chrono::steady_clock;
namespace srv = ur_ros_rtde_msgs::srv;

/// Without a package for this many periods, and at least for this time, the state is outdated.
constexpr double outdated_periods = 5.0;
constexpr double min_outdated_age = 0.5;  // s
}  // namespace

RobotStateReceiver::RobotStateReceiver(rcl_cxx::Node & node, Options options, Source source)
    : node_(node),
      options_(std::move(options)),
      source_(std::move(source)),
      newest_(options_.tf_prefix),
      published_joint_state_(newest_.joint_state),
      status_topics_(node),
      field_topics_(node,
                    {options_.address, options_.tf_prefix, options_.qos, options_.frequency, options_.fields},
                    log_connection(node)),
      recording_(node, options_.address, log_to(node.get_logger())),
      stop_recorder_(log_folder(), options_.address, log_to(node.get_logger())),
      diagnostics_(node, options_.address, [this] { return diagnose(); })
{
  const rcl_cxx::QoS qos = rcl_cxx::QoS::from_name(options_.qos);
  keeps_messages_ = qos.get_rmw_qos_profile().durability != RMW_QOS_POLICY_DURABILITY_VOLATILE;
  joint_states_ = node_.create_publisher<sensor_msgs::msg::JointState>("joint_states", qos);
  actual_joint_states_ = node_.create_publisher<sensor_msgs::msg::JointState>("actual_joint_states", qos);
  tcp_pose_ = node_.create_publisher<geometry_msgs::msg::PoseStamped>("tcp_pose", qos);
  wrench_ = node_.create_publisher<geometry_msgs::msg::WrenchStamped>("wrench", qos);
  io_state_ = node_.create_publisher<ur_ros_rtde_msgs::msg::IOState>("io_state", qos);
  tcp_speed_ = node_.create_publisher<geometry_msgs::msg::TwistStamped>("tcp_speed", qos);
  target_joint_states_ = node_.create_publisher<sensor_msgs::msg::JointState>("target_joint_states", qos);
  if (options_.publish_tf) {
    tool_transform_.emplace(node_, options_.tf_prefix);
  }

  get_joint_state_ = serve<srv::GetJointState>("get_joint_state", &StateMessages::joint_state,
                                               &srv::GetJointState::Response::joint_state);
  get_tcp_pose_ =
      serve<srv::GetTcpPose>("get_tcp_pose", &StateMessages::tcp_pose, &srv::GetTcpPose::Response::tcp_pose);
  get_wrench_ =
      serve<srv::GetWrench>("get_wrench", &StateMessages::wrench, &srv::GetWrench::Response::wrench);
  get_io_state_ =
      serve<srv::GetIOState>("get_io_state", &StateMessages::io_state, &srv::GetIOState::Response::io_state);

  joint_states_are_fake_ =
      node_.create_publisher<std_msgs::msg::Bool>("joint_states_are_fake", rcl_cxx::QoS::transient_local());
  joint_states_are_fake_->publish(std_msgs::msg::Bool());
  publish_fake_ = node_.create_service<std_srvs::srv::SetBool>(
      "publish_fake_joint_states",
      [this](const auto & request, auto & response) { enable_fake_joints(request, response); });
  fake_joint_states_ = node_.create_subscription<sensor_msgs::msg::JointState>(
      "fake_joint_states", rcl_cxx::QoS::reliable(10),
      [this](const sensor_msgs::msg::JointState & message) { set_fake_joints(message); });
}

template <typename S, typename M>
typename rcl_cxx::Service<S>::SharedPtr RobotStateReceiver::serve(const std::string & name,
                                                                  M StateMessages::* source,
                                                                  M S::Response::* destination)
{
  return node_.create_service<S>(name, [this, source, destination](const auto &, auto & response) {
    const std::lock_guard lock(mutex_);
    const Status fresh = freshness();
    response.success = fresh.has_value();
    response.error_code = static_cast<std::uint16_t>(fresh ? ErrorCode::none : fresh.error().code);
    response.message = fresh ? "" : fresh.error().message;
    response.*destination = newest_.*source;
  });
}

Status RobotStateReceiver::freshness() const
{
  const LinkStatus link = source_().link;
  const std::string reason = link.connected ? "this host or the network is late" : link.error.message;
  if (!received_) {
    return failure(ErrorCode::link_lost,
                   fmt::format("no data has been received from the controller yet: {}", reason));
  }
  const double age = std::chrono::duration<double>(Clock::now() - received_->received).count();
  if (!link.connected || age > std::max(min_outdated_age, outdated_periods / options_.frequency)) {
    return failure(
        ErrorCode::link_lost,
        fmt::format("no data has been received from the controller for {:.1f} s: {}", age, reason));
  }
  return {};
}

bool RobotStateReceiver::is_due(const Sample & sample)
{
  const double period = 1.0 / options_.frequency;
  const double tolerance = 0.001;  // half of the shortest control cycle
  if (sample.link != link_) {
    agreed_frequency_ = source_().frequency;
  }
  if (sample.link != link_ || sample.controller_time > next_due_ + period) {
    link_ = sample.link;
    next_due_ = sample.controller_time;
  }
  if (sample.controller_time + tolerance < next_due_) {
    return false;
  }
  next_due_ += period;
  return true;
}

/// The middleware would serialize and store a message that no subscriber receives.
template <typename M>
void RobotStateReceiver::publish_if_subscribed(rcl_cxx::Publisher<M> & publisher, const M & message) const
{
  if (keeps_messages_ || publisher.get_subscription_count() > 0) {
    publisher.publish(message);
  }
}

void RobotStateReceiver::publish(const Sample & sample)
{
  const bool due = is_due(sample);
  packages_.add(sample, agreed_frequency_);
  status_topics_.publish(sample);
  stop_recorder_.add(sample);
  {
    const std::lock_guard lock(mutex_);
    newest_.fill(sample);
    received_ = sample;
  }
  if (!due) {
    return;
  }
  // Only this thread writes newest_, so it may be read here without the lock.
  published_joint_state_.header.stamp = newest_.joint_state.header.stamp;
  const bool fake = fake_.apply(published_joint_state_);
  publish_if_subscribed(*joint_states_, fake ? published_joint_state_ : newest_.joint_state);
  publish_if_subscribed(*tcp_pose_, newest_.tcp_pose);
  publish_if_subscribed(*wrench_, newest_.wrench);
  publish_if_subscribed(*io_state_, newest_.io_state);
  publish_if_subscribed(*tcp_speed_, newest_.tcp_speed);
  publish_if_subscribed(*target_joint_states_, newest_.target_joint_state);
  publish_if_subscribed(*actual_joint_states_, newest_.joint_state);
  if (tool_transform_) {
    tool_transform_->publish(newest_.tcp_pose);
  }
}

std::vector<Diagnosis> RobotStateReceiver::diagnose()
{
  const StateSource source = source_();
  if (!source.link.connected) {
    status_topics_.publish_no_controller();
  }
  std::optional<Sample> sample;
  {
    const std::lock_guard lock(mutex_);
    sample = received_;
  }
  return {diagnose_link(source, options_.address), diagnose_packages(source, packages_.report()),
          diagnose_robot(source, sample)
              .warn_if(fake_.active(),
                       "joint_states has fake positions; those of the robot are on actual_joint_states")
              .value("joint states are fake", fake_.active())};
}

void RobotStateReceiver::enable_fake_joints(const std_srvs::srv::SetBool::Request & request,
                                            std_srvs::srv::SetBool::Response & response)
{
  if (request.data) {
    const std::lock_guard lock(mutex_);
    fake_.begin(newest_.joint_state);
    response.message =
        "joint_states now has fake positions: the current ones, then those received on fake_joint_states";
  } else {
    fake_.end();
    response.message = "joint_states has the positions of the robot again";
  }
  response.success = true;
  std_msgs::msg::Bool fake;
  fake.data = request.data;
  joint_states_are_fake_->publish(fake);
  RCL_CXX_INFO(node_.get_logger(), "{}", response.message);
}

void RobotStateReceiver::set_fake_joints(const sensor_msgs::msg::JointState & message)
{
  if (const auto applied = fake_.set(message); !applied) {
    RCL_CXX_WARN_THROTTLE(node_.get_logger(), std::chrono::seconds(1),
                          "fake_joint_states: message ignored: {}", applied.error());
    return;
  }
  // Without a robot, no package triggers publishing.
  sensor_msgs::msg::JointState shown;
  {
    const std::lock_guard lock(mutex_);
    if (freshness()) {
      return;
    }
    shown = newest_.joint_state;
  }
  shown.header.stamp = node_.now();
  if (fake_.apply(shown)) {
    joint_states_->publish(shown);
  }
}

}  // namespace ur_ros_rtde
