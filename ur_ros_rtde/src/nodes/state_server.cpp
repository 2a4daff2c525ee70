#include "nodes/state_server.hpp"

#include "nodes/node_log.hpp"
#include "nodes/parameters.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {
constexpr const char * node_name = "robot_state_receiver";
}

StateServer::StateServer(const rcl_cxx::Context::SharedPtr & context)
    : node_(std::make_shared<rcl_cxx::Node>(context, node_name))
{
  StateReceiverOptions source;
  source.address = declare_robot_ip(*node_);
  source.silence_limit = declare_silence_limit(*node_);
  source.realtime_priority = declare_realtime_priority(*node_);
  RobotStateReceiver::Options options = declare_state_options(*node_);
  options.address = source.address;
  source.frequency = options.frequency;
  source_ = std::make_unique<StateReceiver>(source, log_connection(*node_));
  receiver_ = std::make_unique<RobotStateReceiver>(*node_, options, [this] {
    return StateSource{source_->link(), source_->version(), source_->frequency()};
  });
  source_->on_sample([this](const Sample & sample) { receiver_->publish(sample); });
}

SharedStateServer::SharedStateServer(const rcl_cxx::Context::SharedPtr & context, Robot & robot)
    : node_(std::make_shared<rcl_cxx::Node>(context, node_name))
{
  const std::string address = declare_robot_ip(*node_);
  RobotStateReceiver::Options options = declare_state_options(*node_);
  options.address = address;
  receiver_ = std::make_unique<RobotStateReceiver>(*node_, options, [&robot] {
    const auto version = robot.version();
    return StateSource{robot.link(), version, version ? version->frequency() : 0.0};
  });
  robot.on_sample([this](const Sample & sample) {
    if (started_) {
      receiver_->publish(sample);
    }
  });
}

}  // namespace ur_ros_rtde
