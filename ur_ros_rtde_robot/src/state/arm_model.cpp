#include "state/arm_model.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "connection/primary_connection.hpp"

namespace ur_ros_rtde {
namespace {

struct Type {
  std::int32_t number;
  std::string_view cb3;
  std::string_view later;
};

// UR, "Client Interface", configuration data; the numbers of the later models as in Universal Robots' client
// library.
constexpr std::array types{
    Type{1, "ur5", "ur5e"}, Type{2, "ur10", "ur10e"}, Type{3, "ur3", "ur3e"},
    Type{4, "", "ur16e"},   Type{5, "", "ur18"},      Type{6, "", "ur8long"},
    Type{7, "", "ur20"},    Type{8, "", "ur30"},      Type{9, "", "ur15"},
};

/// The model that the controller reports for `model`.
std::string reported_model(const std::string & model)
{
  return model == "ur7e" ? "ur5e" : model == "ur12e" ? "ur10e" : model;
}

/// Text for messages: the possible models.
std::string describe(const std::string & detected)
{
  return detected == "ur5e" ? "ur5e (or ur7e)" : detected == "ur10e" ? "ur10e (or ur12e)" : detected;
}

ArmLimits limits_of_stated(const std::string & model)
{
  if (model.empty()) {
    return common_arm_limits();
  }
  if (const auto limits = arm_limits(model)) {
    return *limits;
  }
  throw std::invalid_argument(
      fmt::format("there is no model \"{}\" of the arm, there are {}", model, arm_models()));
}

}  // namespace

std::optional<std::string> model_of_type(std::int32_t number, bool cb3)
{
  for (const Type & type : types) {
    const auto name = cb3 ? type.cb3 : type.later;
    if (type.number == number && !name.empty()) {
      return std::string(name);
    }
  }
  return std::nullopt;
}

ArmModel::ArmModel(std::string address, std::string stated, LogFunction log)
    : address_(std::move(address)),
      stated_(normalized_model_name(stated)),
      logger_(std::move(log)),
      limits_(limits_of_stated(stated_))
{
}

void ArmModel::report_undetected(const std::string & why)
{
  {
    const std::lock_guard lock(mutex_);
    detected_.reset();
    limits_ = limits_of_stated(stated_);
  }
  const std::string consequence =
      stated_.empty() ? "motions are limited to what every model can do: set the parameter ur_type to the "
                        "model on the arm's base"
                      : fmt::format("the parameter ur_type ({}) cannot be verified", stated_);
  logger_.log_on_change(LogLevel::warn,
                        fmt::format("the controller at {} does not report the model of the arm ({}); {}",
                                    address_, why, consequence));
}

void ArmModel::detect(const ControllerVersion & version, std::chrono::milliseconds timeout)
{
  auto primary = PrimaryConnection::connect(address_, timeout);
  const auto arm = primary ? primary->arm_data(timeout) : Expected<ArmData>(tl::unexpected(primary.error()));
  {
    const std::lock_guard lock(mutex_);
    calibration_ = arm ? arm->dh_rows : std::nullopt;
  }
  if (!arm) {
    return report_undetected(arm.error().message);
  }
  const auto model = model_of_type(arm->type, version.cb3());
  if (!model) {
    return report_undetected(
        fmt::format("type {} with PolyScope {} is unknown", arm->type, to_string(version)));
  }
  {
    const std::lock_guard lock(mutex_);
    detected_ = model;
    limits_ = stated_.empty() ? arm_limits(*model).value_or(common_arm_limits()) : limits_of_stated(stated_);
  }
  logger_.log_on_change(LogLevel::info, fmt::format("the arm at {} is a {}", address_, describe(*model)));
}

ArmLimits ArmModel::limits() const
{
  const std::lock_guard lock(mutex_);
  return limits_;
}

std::string ArmModel::name() const
{
  const std::lock_guard lock(mutex_);
  return stated_.empty() ? detected_.value_or("") : stated_;
}

std::optional<kinematics::DhRows> ArmModel::calibration() const
{
  const std::lock_guard lock(mutex_);
  return calibration_;
}

std::optional<Error> ArmModel::mismatch() const
{
  const std::lock_guard lock(mutex_);
  if (stated_.empty() || !detected_ || reported_model(stated_) == *detected_) {
    return std::nullopt;
  }
  return Error{
      ErrorCode::model_mismatch,
      fmt::format("ur_type is {}, but the arm at {} is a {}: start the driver again with ur_type:={}, "
                  "or with an empty one to use the detected model, or with the address of the "
                  "right robot",
                  stated_, address_, describe(*detected_), *detected_)};
}

}  // namespace ur_ros_rtde
