#include "controller/options.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace ur_simulator {
namespace {

/// Returns the factor; throws unless it is in the range that the options allow.
double checked_factor(double factor, double largest, std::string_view what, std::string_view option)
{
  constexpr double smallest = 0.01;
  if (!(factor >= smallest && factor <= largest)) {
    throw std::runtime_error(
        fmt::format("{} {} ({}) is out of range: give {} to {}", what, factor, option, smallest, largest));
  }
  return factor;
}

}  // namespace

RobotModel select_model(const SimulatorOptions & options)
{
  const auto model = find_robot_model(options.model);
  if (!model) {
    throw std::runtime_error(model.error());
  }
  return options.calibration_seed == 0 ? model->get()
                                       : with_random_calibration(model->get(), options.calibration_seed);
}

PolyscopeVersion select_version(const SimulatorOptions & options, const RobotModel & model)
{
  const bool cb3 = model.series == Series::cb3;
  const std::string text =
      options.polyscope_version.empty() ? (cb3 ? "3.15.8" : "5.25.1") : options.polyscope_version;
  const auto version = PolyscopeVersion::parse(text);
  constexpr PolyscopeVersion first_polyscope_x{10, 7, 0, 0};
  const bool known = version && (version->major == 3 || version->major == 5 ||
                                 (version->major == 10 && *version >= first_polyscope_x));
  if (!known) {
    throw std::runtime_error(fmt::format(
        "PolyScope version '{}' (--polyscope) is not supported: give 3.x, 5.x or, for PolyScope X, "
        "10.7 or later, such as 5.25.1",
        text));
  }
  if (version->is_e_series() == cb3) {
    throw std::runtime_error(
        fmt::format("model {} does not run PolyScope {}: CB3 models (ur3, ur5, ur10) run 3.x, all "
                    "others 5.x and 10.x (--model, --polyscope)",
                    model.name, text));
  }
  return *version;
}

Vector6 initial_joint_positions(const SimulatorOptions & options, const RobotModel & model)
{
  if (!options.initial_joints) {
    return default_position(model);
  }
  const Vector6 joints(options.initial_joints->data());
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (!(joints[i] >= model.position_min[i] && joints[i] <= model.position_max[i])) {
      throw std::runtime_error(fmt::format("initial joint {} is {} rad: model {} allows {} to {}", i,
                                           joints[i], model.name, model.position_min[i],
                                           model.position_max[i]));
    }
  }
  return joints;
}

std::chrono::steady_clock::duration cycle_period(const SimulatorOptions & options,
                                                 const PolyscopeVersion & version)
{
  const double factor =
      checked_factor(options.real_time_factor, 1000.0, "real-time factor", "--real-time-factor");
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(version.cycle_time() / factor));
}

SafetyTimes safety_times(const SimulatorOptions & options)
{
  const double factor =
      checked_factor(options.recovery_time_factor, 10.0, "recovery time factor", "--recovery-time-factor");
  SafetyTimes times;
  for (double SafetyTimes::* time : {&SafetyTimes::power_on, &SafetyTimes::brake_release,
                                     &SafetyTimes::unlock_delay, &SafetyTimes::restart}) {
    times.*time *= factor;
  }
  return times;
}

PendantOptions pendant_options(const SimulatorOptions & options, const PolyscopeVersion & version)
{
  PendantOptions result;
  result.version = version;
  result.remote_control = options.remote_control;
  result.reports_folder = options.reports_folder;
  return result;
}

World create_world(const SimulatorOptions & options, const RobotModel & model)
{
  World world(model, options.seed);
  for (const std::string & urcap : options.urcaps) {
    if (urcap == "onrobot_soft_gripper") {
      world.mount_gripper();
    } else if (urcap == "robotiq_gripper") {
      world.mount_robotiq_gripper();
    } else {
      throw std::runtime_error(fmt::format(
          "URCap '{}' (--urcap) is not supported: give onrobot_soft_gripper or robotiq_gripper", urcap));
    }
  }
  if (options.digital_gripper == "single" || options.digital_gripper == "double") {
    world.mount_digital_gripper(options.digital_gripper == "double");
  } else if (!options.digital_gripper.empty()) {
    throw std::runtime_error(
        fmt::format("digital gripper '{}' (--digital-gripper) is not supported: give single or double",
                    options.digital_gripper));
  }
  return world;
}

}  // namespace ur_simulator
