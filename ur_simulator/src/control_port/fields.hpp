#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator::control_port {

/// A request that cannot be carried out; the text names field, value and limit.
class RequestError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Range {
  double least;
  double most;
};

/// Typed access to a request's fields. Every getter throws RequestError; finish() rejects fields nobody asked
/// for, so that a misspelt one does not pass in silence.
class Fields {
 public:
  explicit Fields(const nlohmann::json & request);

  bool has(std::string_view name) const;
  double number(const std::string & name, Range range, std::optional<double> fallback = {});
  std::int64_t integer(const std::string & name, std::int64_t least, std::int64_t most,
                       std::optional<std::int64_t> fallback = {});
  bool boolean(const std::string & name, std::optional<bool> fallback = {});
  std::string text(const std::string & name, std::optional<std::string> fallback = {});
  /// One of the choices.
  std::string choice(const std::string & name, std::span<const std::string_view> choices,
                     std::optional<std::string> fallback = {});
  Vector3 vector3(const std::string & name, Range range, std::optional<Vector3> fallback = {});
  Vector6 vector6(const std::string & name, Range range, std::optional<Vector6> fallback = {});
  /// Throws when the request has a field that was not read.
  void finish() const;

 private:
  const nlohmann::json * find(const std::string & name, bool optional);
  std::vector<double> numbers(const std::string & name, std::size_t count, Range range);

  const nlohmann::json & request_;
  std::vector<std::string> read_;
};

}  // namespace ur_simulator::control_port
