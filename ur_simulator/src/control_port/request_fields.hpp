#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator::control_port {

/// An invalid request. The text states field, value and limit.
class RequestError : public std::runtime_error {
 public:
  explicit RequestError(const std::string & text, std::string field = "")
      : std::runtime_error(text), field_(std::move(field))
  {
  }
  /// The invalid field; empty if the error concerns no field or a missing one.
  const std::string & field() const { return field_; }

 private:
  std::string field_;
};

struct Range {
  double min;
  double max;
};

/// Typed access to the fields of a request. All functions throw RequestError if the field is invalid, or
/// missing without a default.
class RequestFields {
 public:
  /// `request` must outlive the object.
  explicit RequestFields(const nlohmann::json & request);

  bool has(std::string_view name) const;
  double number(const std::string & name, Range range, std::optional<double> default_value = {});
  std::int64_t integer(const std::string & name, std::int64_t min, std::int64_t max,
                       std::optional<std::int64_t> default_value = {});
  bool boolean(const std::string & name, std::optional<bool> default_value = {});
  std::string string(const std::string & name, std::optional<std::string> default_value = {});
  /// A string that is one of the choices.
  std::string choice(const std::string & name, std::span<const std::string_view> choices,
                     std::optional<std::string> default_value = {});
  /// A boolean, a number or a string.
  nlohmann::json scalar(const std::string & name);
  Vector3 vector3(const std::string & name, Range range, std::optional<Vector3> default_value = {});
  Vector6 vector6(const std::string & name, Range range, std::optional<Vector6> default_value = {});
  /// Throws RequestError if the request has a field that has not been read, such as a misspelled one.
  void reject_unknown() const;

 private:
  const nlohmann::json * find(const std::string & name, bool optional);
  std::vector<double> numbers(const std::string & name, std::size_t count, Range range);

  const nlohmann::json & request_;
  std::vector<std::string> read_names_;
};

}  // namespace ur_simulator::control_port
