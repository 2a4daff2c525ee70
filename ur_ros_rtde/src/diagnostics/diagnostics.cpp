#include "diagnostics/diagnostics.hpp"

#include <chrono>
#include <utility>

namespace ur_ros_rtde {

Diagnosis & Diagnosis::add(std::uint8_t level, std::string message)
{
  if (status_.message.empty() || level > status_.level) {
    status_.level = level;
    status_.message = std::move(message);
  }
  return *this;
}

Diagnosis & Diagnosis::warn_if(bool holds, std::string message)
{
  return holds ? add(Status::WARN, std::move(message)) : *this;
}

Diagnosis & Diagnosis::error_if(bool holds, std::string message)
{
  return holds ? add(Status::ERROR, std::move(message)) : *this;
}

Diagnostics::Diagnostics(rcl_cxx::Node & node, std::string hardware_id, Examine examine)
    : node_(node),
      hardware_id_(std::move(hardware_id)),
      examine_(std::move(examine)),
      publisher_(node.create_publisher<diagnostic_msgs::msg::DiagnosticArray>("/diagnostics",
                                                                              rcl_cxx::QoS::reliable(10))),
      timer_(node.create_wall_timer(std::chrono::seconds(1), [this] { publish(); }))
{
}

void Diagnostics::publish()
{
  diagnostic_msgs::msg::DiagnosticArray array;
  array.header.stamp = node_.now();
  for (Diagnosis & diagnosis : examine_()) {
    array.status.push_back(diagnosis.take());
    array.status.back().name =
        fmt::format("{}: {}", node_.get_fully_qualified_name(), array.status.back().name);
    array.status.back().hardware_id = hardware_id_;
  }
  publisher_->publish(array);
}

}  // namespace ur_ros_rtde
