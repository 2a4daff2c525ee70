#pragma once

#include <fmt/format.h>

#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <functional>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

namespace ur_ros_rtde {

/// Collects one entry of /diagnostics.
class Diagnosis {
 public:
  using Status = diagnostic_msgs::msg::DiagnosticStatus;

  explicit Diagnosis(std::string name) { status_.name = std::move(name); }

  /// Adds a finding. The entry has the highest level, and the message of the first finding with that level.
  Diagnosis & add(std::uint8_t level, std::string message);
  Diagnosis & ok(std::string message) { return add(Status::OK, std::move(message)); }
  Diagnosis & warn_if(bool holds, std::string message);
  Diagnosis & error_if(bool holds, std::string message);
  template <typename T>
  Diagnosis & value(std::string key, const T & value)
  {
    status_.values.emplace_back();
    status_.values.back().key = std::move(key);
    status_.values.back().value = fmt::format("{}", value);
    return *this;
  }
  Status take() { return std::move(status_); }

 private:
  Status status_;
};

/// Publishes the findings of a node on /diagnostics once per second. The entries are named `<node>: <name>`,
/// with the namespace of the node.
class Diagnostics {
 public:
  using Examine = std::function<std::vector<Diagnosis>()>;

  /// `examine` is called in the executor's thread. `hardware_id`: address of the robot.
  Diagnostics(rcl_cxx::Node & node, std::string hardware_id, Examine examine);

 private:
  void publish();

  rcl_cxx::Node & node_;
  const std::string hardware_id_;
  const Examine examine_;
  rcl_cxx::Publisher<diagnostic_msgs::msg::DiagnosticArray>::SharedPtr publisher_;
  rcl_cxx::Timer::SharedPtr timer_;  ///< destroyed first, so that `examine` is not called anymore
};

}  // namespace ur_ros_rtde
