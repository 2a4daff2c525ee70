#pragma once

#include <memory>
#include <rosgraph_msgs/msg/clock.hpp>

#include "parameters/parameters.hpp"
#include "rcl_cxx/node.hpp"

namespace rcl_cxx::detail {
/// The parameter use_sim_time: while it is true, the node's clock follows /clock.
class SimTime {
 public:
  SimTime(Node & node, Parameters & parameters);

 private:
  void follow(bool use_sim_time);

  Node & node_;
  std::shared_ptr<Subscription<rosgraph_msgs::msg::Clock>> clock_;
};

}  // namespace rcl_cxx::detail
