#include "state/description_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_ros_rtde {
namespace {

/// The calibration of an arm deviates less from its model (docs/use/description.md).
constexpr FlangeDeviation largest_calibration{0.015, 0.03};

std::string describe(const FlangeDeviation & deviation, const std::string & address)
{
  const bool other_arm =
      deviation.distance > largest_calibration.distance || deviation.angle > largest_calibration.angle;
  return fmt::format(
      "robot_description differs from the arm at {}: the flange deviates by up to {:.2f} mm and {:.5f} rad, "
      "and "
      "with it what TF and MoveIt compute. {}",
      address, 1e3 * deviation.distance, deviation.angle,
      other_arm
          ? "It describes another model: generate the description with the model of the arm, which the "
            "driver "
            "logs when it connects"
          : fmt::format("It has another calibration: save that of the arm with `ur calibration --robot {} "
                        "--output FILE`, and generate the description with kinematics_params_file:=FILE",
                        address));
}

}  // namespace

DescriptionCheck::DescriptionCheck(rcl_cxx::Node & node, Robot & robot, std::string prefix)
    : node_(node), robot_(robot), prefix_(std::move(prefix))
{
  subscription_ = node_.create_subscription<std_msgs::msg::String>(
      "robot_description", rcl_cxx::QoS::transient_local(), [this](const std_msgs::msg::String & message) {
        description_ = read_description(message.data, prefix_);
        warned_ = false;
      });
}

std::optional<Diagnosis> DescriptionCheck::diagnose()
{
  const auto calibration = robot_.calibration();
  if (!description_ || !calibration) {
    return std::nullopt;
  }
  const FlangeDeviation deviation = compare_kinematics(*description_, *calibration);
  Diagnosis diagnosis("description");
  diagnosis.value("deviation of the flange in mm", 1e3 * deviation.distance)
      .value("deviation of the flange in rad", deviation.angle);
  if (deviation.is_negligible()) {
    return std::move(diagnosis.ok("robot_description agrees with the calibration of the arm"));
  }
  const std::string finding = describe(deviation, robot_.address());
  warn_once(finding);
  return std::move(diagnosis.warn_if(true, finding));
}

void DescriptionCheck::warn_once(const std::string & finding)
{
  if (!std::exchange(warned_, true)) {
    RCL_CXX_WARN(node_.get_logger(), "{}", finding);
  }
}

}  // namespace ur_ros_rtde
