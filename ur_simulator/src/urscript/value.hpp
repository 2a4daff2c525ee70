#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator::urscript {

enum class Type : std::uint8_t { none, boolean, integer, floating, string, pose, list, matrix, structure };

/// The type's name as error messages show it ("int", "pose", …).
std::string_view name_of(Type type);

class Value;

using List = std::vector<Value>;

/// Rows of equal length; numbers only, as in URScript ("Matrix and Array Expressions" of the script manual).
struct Matrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> elements;  ///< row by row

  double at(std::size_t row, std::size_t column) const { return elements[row * columns + column]; }
  double & at(std::size_t row, std::size_t column) { return elements[row * columns + column]; }
  bool operator==(const Matrix &) const = default;
};

/// Named members in the order of their declaration: `struct(x = 1, label = "a")`.
struct Structure;

/// A URScript value. Copying is cheap (strings, lists, poses, matrices and structures are shared until one of
/// them is written), and has the language's meaning: each variable has its own. Integers are 32 bit, as on
/// the controller.
class Value {
 public:
  Value() = default;
  Value(bool value) : data_(value) {}  // NOLINT(google-explicit-constructor): literals of the language
  Value(std::int32_t value) : data_(value) {}  // NOLINT(google-explicit-constructor)
  Value(double value) : data_(value) {}        // NOLINT(google-explicit-constructor)
  Value(std::string value);                    // NOLINT(google-explicit-constructor)
  Value(const char * value);                   // NOLINT(google-explicit-constructor)
  Value(List value);                           // NOLINT(google-explicit-constructor)
  Value(Matrix value);                         // NOLINT(google-explicit-constructor)
  Value(Structure value);                      // NOLINT(google-explicit-constructor)
  /// p[x, y, z, rx, ry, rz] in m and rad (rotation vector).
  static Value pose(const Vector6 & pose);
  /// A list of six numbers (joint positions, a wrench, …).
  static Value list(const Vector6 & values);
  static Value list(const Vector3 & values);

  Type type() const { return static_cast<Type>(data_.index()); }
  bool is(Type type) const { return this->type() == type; }
  bool is_number() const { return is(Type::integer) || is(Type::floating); }

  /// The following require the right type (see type()).
  bool boolean() const { return std::get<bool>(data_); }
  std::int32_t integer() const { return std::get<std::int32_t>(data_); }
  double floating() const { return std::get<double>(data_); }
  const std::string & string() const { return *std::get<std::shared_ptr<std::string>>(data_); }
  const Vector6 & pose() const { return *std::get<std::shared_ptr<Vector6>>(data_); }
  const List & list() const { return *std::get<std::shared_ptr<List>>(data_); }
  const Matrix & matrix() const { return *std::get<std::shared_ptr<Matrix>>(data_); }
  const Structure & structure() const { return *std::get<std::shared_ptr<Structure>>(data_); }

  /// As above, for writing: detached from every other value that shares the storage.
  Vector6 & own_pose() { return own<Vector6>(); }
  List & own_list() { return own<List>(); }
  Matrix & own_matrix() { return own<Matrix>(); }
  Structure & own_structure() { return own<Structure>(); }

  /// An int or float as double; a bool counts as 0 or 1, as in URScript's mixed comparisons. Nothing for
  /// other types.
  std::optional<double> number() const;
  /// A list of six numbers or a pose.
  std::optional<Vector6> vector6() const;
  std::optional<Vector3> vector3() const;

  /// As to_str() and textmsg() show it: True, 3, 0.5, [1, 2], p[…]; strings without quotes at the top level.
  std::string text() const;

 private:
  template <typename T>
  T & own()
  {
    auto & shared = std::get<std::shared_ptr<T>>(data_);
    if (shared.use_count() != 1) {
      shared = std::make_shared<T>(*shared);
    }
    return *shared;
  }

  // In the order of Type.
  std::variant<std::monostate, bool, std::int32_t, double, std::shared_ptr<std::string>,
               std::shared_ptr<Vector6>, std::shared_ptr<List>, std::shared_ptr<Matrix>,
               std::shared_ptr<Structure>>
      data_;
};

struct Structure {
  std::vector<std::pair<std::string, Value>> members;

  Value * find(std::string_view name);
  const Value * find(std::string_view name) const;
};

/// Equality of the language: numbers by value across int, float and bool; containers by element.
bool equal(const Value & left, const Value & right);

}  // namespace ur_simulator::urscript
