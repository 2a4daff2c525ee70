#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace rcl_cxx {
/// The numbers are those of rcl_interfaces/msg/ParameterType.
enum class ParameterType : std::uint8_t {
  not_set = 0,
  boolean = 1,
  integer = 2,
  floating_point = 3,
  string = 4,
  byte_array = 5,
  boolean_array = 6,
  integer_array = 7,
  floating_point_array = 8,
  string_array = 9
};

/// As in rclcpp: "not set", "bool", "integer", "double", "string", "byte_array", …
std::string_view to_string(ParameterType type) noexcept;

/// The value of a parameter, or not set.
class ParameterValue {
 public:
  /// In the order of ParameterType.
  using Variant = std::variant<std::monostate, bool, std::int64_t, double, std::string,
                               std::vector<std::uint8_t>, std::vector<bool>, std::vector<std::int64_t>,
                               std::vector<double>, std::vector<std::string>>;

  ParameterValue() = default;
  ParameterValue(bool value) : value_(value) {}
  template <std::integral T>
    requires(!std::same_as<T, bool>)
  ParameterValue(T value) : value_(narrow<std::int64_t>(value))
  {
  }
  template <std::floating_point T>
  ParameterValue(T value) : value_(static_cast<double>(value))
  {
  }
  ParameterValue(const char * value) : value_(std::string(value)) {}
  ParameterValue(std::string_view value) : value_(std::string(value)) {}
  ParameterValue(std::string value) : value_(std::move(value)) {}
  ParameterValue(std::vector<std::uint8_t> value) : value_(std::move(value)) {}
  ParameterValue(std::vector<bool> value) : value_(std::move(value)) {}
  ParameterValue(std::vector<std::int64_t> value) : value_(std::move(value)) {}
  ParameterValue(std::vector<double> value) : value_(std::move(value)) {}
  ParameterValue(std::vector<std::string> value) : value_(std::move(value)) {}

  ParameterType get_type() const noexcept { return static_cast<ParameterType>(value_.index()); }
  const Variant & variant() const noexcept { return value_; }
  /// For messages: `12`, `'text'`, `[1.0, 2.0]`, `not set`.
  std::string to_string() const;

  /// T is bool, an integer or floating-point type, std::string, or a vector of bool, std::uint8_t,
  /// std::int64_t, double, std::string.
  /// @throws Error if the value has another type, or is an integer that does not fit into T.
  template <typename T>
  T get() const;

  bool operator==(const ParameterValue &) const = default;

 private:
  [[noreturn]] void throw_wrong_type(ParameterType wanted) const;
  [[noreturn]] static void throw_does_not_fit(const std::string & value);

  template <typename V>
  const V & as() const
  {
    if (const V * value = std::get_if<V>(&value_)) {
      return *value;
    }
    throw_wrong_type(ParameterValue(V()).get_type());
  }

  template <std::integral To, std::integral From>
  static To narrow(From value)
  {
    if (!std::in_range<To>(value)) {
      throw_does_not_fit(std::to_string(value));
    }
    return static_cast<To>(value);
  }

  Variant value_;
};

template <typename T>
T ParameterValue::get() const
{
  if constexpr (std::integral<T> && !std::same_as<T, bool>) {
    return narrow<T>(as<std::int64_t>());
  } else if constexpr (std::floating_point<T>) {
    return static_cast<T>(as<double>());
  } else {
    return as<T>();
  }
}

}  // namespace rcl_cxx
