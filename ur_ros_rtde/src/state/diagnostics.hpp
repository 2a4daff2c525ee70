#pragma once

#include <fmt/format.h>

#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <functional>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

namespace ur_ros_rtde {

/// One entry of /diagnostics in the making.
class Diagnosis {
 public:
  using Status = diagnostic_msgs::msg::DiagnosticStatus;

  explicit Diagnosis(std::string name) { status_.name = std::move(name); }

  /// The worst that is said counts; of equal ones the first.
  Diagnosis & say(std::uint8_t level, std::string message);
  Diagnosis & ok(std::string message) { return say(Status::OK, std::move(message)); }
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

/// Publishes what a node finds on /diagnostics, once a second: the entries are called `<node>: <name>`, the
/// node with its namespace.
class Diagnostics {
 public:
  using Examine = std::function<std::vector<Diagnosis>()>;

  /// `examine` is called in the executor's thread. `hardware_id`: the robot's address.
  Diagnostics(rcl_cxx::Node & node, std::string hardware_id, Examine examine);

 private:
  void publish();

  rcl_cxx::Node & node_;
  const std::string hardware_id_;
  const Examine examine_;
  rcl_cxx::Publisher<diagnostic_msgs::msg::DiagnosticArray>::SharedPtr publisher_;
  rcl_cxx::Timer::SharedPtr timer_;  ///< goes first: nothing is examined any more
};

}  // namespace ur_ros_rtde
