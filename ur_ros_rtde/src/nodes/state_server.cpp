#include "nodes/state_server.hpp"

#include "nodes/node_log.hpp"
#include "nodes/parameters.hpp"
#include "ur_ros_rtde/robot.hpp"

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
  RobotStateReceiver::Options options = declare_state_options(*node_);
  source.frequency = options.frequency;
  source_ = std::make_unique<StateReceiver>(source, log_into(node_->logger()));
  options.link_problem = [this] { return source_->link().error.message; };
  receiver_ = std::make_unique<RobotStateReceiver>(*node_, options);
  source_->on_sample([this](const Sample & sample) { receiver_->publish(sample); });
}

SharedStateServer::SharedStateServer(const rcl_cxx::Context::SharedPtr & context, Robot & robot)
    : node_(std::make_shared<rcl_cxx::Node>(context, node_name))
{
  declare_robot_ip(*node_);
  RobotStateReceiver::Options options = declare_state_options(*node_);
  options.link_problem = [&robot] { return robot.status().message; };
  receiver_ = std::make_unique<RobotStateReceiver>(*node_, options);
  robot.on_sample([this](const Sample & sample) { receiver_->publish(sample); });
}

}  // namespace ur_ros_rtde
