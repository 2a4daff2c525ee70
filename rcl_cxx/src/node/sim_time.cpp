#include "node/sim_time.hpp"

#include "node/node_impl.hpp"
#include "rcl_support/to_time.hpp"

namespace rcl_cxx::detail {
namespace {
constexpr const char * kName = "use_sim_time";
}

SimTime::SimTime(Node & node, Parameters & parameters) : node_(node)
{
  follow(parameters.declare(kName, false, {}).get<bool>());
  parameters.add_on_change([this](const ParameterChanges & changes) {
    for (const Parameter & parameter : changes.changed) {
      if (parameter.name == kName) {
        follow(parameter.value.get<bool>());
      }
    }
  });
}

void SimTime::follow(bool use_sim_time)
{
  if (use_sim_time == (clock_ != nullptr)) {
    return;
  }
  const std::weak_ptr<NodeImpl> weak = node_.impl();
  if (use_sim_time) {
    node_.impl()->get_clock().override_with(0);  // until the first message, as in rclcpp
    clock_ = node_.create_subscription<rosgraph_msgs::msg::Clock>(
        "/clock", QoS::best_effort(1), [weak](const rosgraph_msgs::msg::Clock & message) {
          if (const auto impl = weak.lock()) {
            impl->get_clock().override_with(to_ns(message.clock));
          }
        });
  } else {
    clock_.reset();
    node_.impl()->get_clock().override_with(std::nullopt);
  }
}

}  // namespace rcl_cxx::detail
