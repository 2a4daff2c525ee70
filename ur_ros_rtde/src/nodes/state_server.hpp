#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "nodes/robot_state_receiver.hpp"
#include "nodes/server.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

class Robot;

/// The node robot_state_receiver with its own connection to the controller.
class StateServer : public Server {
 public:
  explicit StateServer(const rcl_cxx::Context::SharedPtr & context);
  rcl_cxx::Node & node() override { return *node_; }
  void start() override { source_->start(); }

 private:
  rcl_cxx::Node::SharedPtr node_;
  std::unique_ptr<RobotStateReceiver> receiver_;
  std::unique_ptr<StateReceiver> source_;
};

/// The node robot_state_receiver with the samples of a Robot in the same process. Construct it before the
/// robot is started.
class SharedStateServer : public Server {
 public:
  SharedStateServer(const rcl_cxx::Context::SharedPtr & context, Robot & robot);
  rcl_cxx::Node & node() override { return *node_; }
  void start() override { started_ = true; }

 private:
  std::atomic<bool> started_ = false;
  rcl_cxx::Node::SharedPtr node_;
  std::unique_ptr<RobotStateReceiver> receiver_;
};

}  // namespace ur_ros_rtde
