#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "urscript/library.hpp"

namespace ur_simulator::urscript {

/// Reads the arguments of a builtin by position and type. The first argument that does not fit determines the
/// failure; further reads return zero. A builtin therefore reads all arguments first and checks for a failure
/// once.
class ArgumentReader {
 public:
  explicit ArgumentReader(Arguments arguments) : arguments_(arguments) {}

  bool given(std::size_t i) const { return i < arguments_.size() && !arguments_[i].is(Type::none); }
  const Value & value(std::size_t i) const { return arguments_[i]; }

  /// A finite number.
  double number(std::size_t i, const char * name)
  {
    const auto number = arguments_[i].is_number() ? arguments_[i].number() : std::nullopt;
    if (!number || !std::isfinite(*number)) {
      return reject_type(name, "a finite number", i), 0.0;
    }
    return *number;
  }

  std::int32_t integer(std::size_t i, const char * name)
  {
    if (arguments_[i].is(Type::integer)) {
      return arguments_[i].integer();
    }
    // Integral floats are accepted: registers and counters are often floats.
    const auto number = arguments_[i].number();
    if (!number || std::floor(*number) != *number || std::abs(*number) > 2147483647.0) {
      return reject_type(name, "an int", i), 0;
    }
    return static_cast<std::int32_t>(*number);
  }

  bool boolean(std::size_t i, const char * name)
  {
    const auto number = arguments_[i].number();
    if (!number) {
      return reject_type(name, "a bool", i), false;
    }
    return *number != 0.0;
  }

  std::string string(std::size_t i, const char * name)
  {
    if (!arguments_[i].is(Type::string)) {
      return reject_type(name, "a string", i), std::string();
    }
    return arguments_[i].string();
  }

  /// A pose, or a list of six numbers read as one.
  Vector6 pose(std::size_t i, const char * name) { return read_vector6(i, name, "a pose"); }
  /// A list of six numbers (or a pose).
  Vector6 vector6(std::size_t i, const char * name) { return read_vector6(i, name, "a list of six numbers"); }

  Vector3 vector3(std::size_t i, const char * name)
  {
    const auto vector = arguments_[i].vector3();
    if (!vector || !vector->allFinite()) {
      return reject_type(name, "a list of three numbers", i), Vector3::Zero();
    }
    return *vector;
  }

  /// A selection vector: six numbers, each 0 or 1.
  std::array<bool, 6> selection(std::size_t i, const char * name)
  {
    std::array<bool, 6> result{};
    const Vector6 values = vector6(i, name);
    for (std::size_t axis = 0; axis < result.size(); ++axis) {
      const double value = values[static_cast<Eigen::Index>(axis)];
      require(value == 0.0 || value == 1.0, fmt::format("{}[{}] must be 0 or 1, is {}", name, axis, value));
      result[axis] = value == 1.0;
    }
    return result;
  }

  void require(bool condition, std::string message)
  {
    if (!condition && message_.empty()) {
      message_ = std::move(message);
    }
  }

  explicit operator bool() const { return message_.empty(); }
  Failure failure() const { return {message_}; }

 private:
  Vector6 read_vector6(std::size_t i, const char * name, const char * expected)
  {
    const auto vector = arguments_[i].vector6();
    if (!vector || !vector->allFinite()) {
      return reject_type(name, expected, i), Vector6::Zero();
    }
    return *vector;
  }

  void reject_type(const char * name, const char * expected, std::size_t i)
  {
    const std::string found = arguments_[i].text().substr(0, 60);
    require(false, fmt::format("the argument '{}' must be {}, not {} {}", name, expected,
                               name_of(arguments_[i].type()), found));
  }

  Arguments arguments_;
  std::string message_;
};

}  // namespace ur_simulator::urscript
