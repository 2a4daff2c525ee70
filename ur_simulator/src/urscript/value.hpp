#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator::urscript {

enum class Type : std::uint8_t {
  none,
  boolean,
  integer,
  floating,
  string,
  pose,
  list,
  matrix,
  structure,
  remote
};

/// The name of the type in error messages ("int", "pose", …).
std::string_view name_of(Type type);

class Value;
class RemoteObject;

using List = std::vector<Value>;

/// How a value is written.
enum class TextFormat : std::uint8_t {
  string,  ///< to_str(), str_cat(): six decimals without trailing zeros (script manual)
  message  ///< textmsg(), socket_send_string(): six significant digits, poses without blanks (recorded)
};

/// A matrix of numbers (script manual, "Matrix and Array Expressions").
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

/// A URScript value with value semantics. Copying is cheap: strings, lists, poses, matrices and structures
/// are shared until one copy is written. Integers have 32 bits, as on the controller.
class Value {
 public:
  Value() = default;
  Value(bool value) : type_(Type::boolean)
  {
    scalar_.boolean = value;
  }  // NOLINT(google-explicit-constructor)
  Value(std::int32_t value) : type_(Type::integer)
  {
    scalar_.integer = value;
  }  // NOLINT(google-explicit-constructor)
  Value(double value) : type_(Type::floating)
  {
    scalar_.floating = value;
  }  // NOLINT(google-explicit-constructor)
  Value(std::string value);                     // NOLINT(google-explicit-constructor)
  Value(const char * value);                    // NOLINT(google-explicit-constructor)
  Value(List value);                            // NOLINT(google-explicit-constructor)
  Value(Matrix value);                          // NOLINT(google-explicit-constructor)
  Value(Structure value);                       // NOLINT(google-explicit-constructor)
  Value(std::shared_ptr<RemoteObject> object);  // NOLINT(google-explicit-constructor)
  /// p[x, y, z, rx, ry, rz] in m and rad (rotation vector).
  static Value pose(const Vector6 & pose);
  /// A list of six numbers (joint positions, a wrench, …).
  static Value list(const Vector6 & values);
  static Value list(const Vector3 & values);

  Type type() const { return type_; }
  bool is(Type type) const { return type_ == type; }
  bool is_number() const { return type_ == Type::integer || type_ == Type::floating; }

  /// The following accessors require that type() matches.
  bool boolean() const { return scalar_.boolean; }
  std::int32_t integer() const { return scalar_.integer; }
  double floating() const { return scalar_.floating; }
  const std::string & string() const { return get<std::string>(); }
  const Vector6 & pose() const { return get<Vector6>(); }
  const List & list() const { return get<List>(); }
  const Matrix & matrix() const { return get<Matrix>(); }
  const Structure & structure() const { return get<Structure>(); }
  /// Copies refer to the same object.
  RemoteObject & remote() const { return *static_cast<RemoteObject *>(shared_.get()); }

  /// Accessors for writing. They copy the storage if other values share it.
  Vector6 & own_pose() { return own<Vector6>(); }
  List & own_list() { return own<List>(); }
  Matrix & own_matrix() { return own<Matrix>(); }
  Structure & own_structure() { return own<Structure>(); }

  /// An int, float or bool (0 or 1, as in URScript's mixed comparisons) as double; nothing for other types.
  std::optional<double> number() const;
  /// Identifies the storage that copies share; null for scalars.
  const void * storage() const { return shared_.get(); }
  bool shares_storage() const { return shared_.use_count() > 1; }
  /// A list of six numbers or a pose.
  std::optional<Vector6> vector6() const;
  std::optional<Vector3> vector3() const;

  /// True, 3, 0.5, [1, 2], p[…]; strings have no quotes at the top level.
  std::string text(TextFormat format = TextFormat::string) const;

 private:
  template <typename T>
  Value(Type type, std::shared_ptr<T> shared) : type_(type), shared_(std::move(shared))
  {
  }
  template <typename T>
  const T & get() const
  {
    return *static_cast<const T *>(shared_.get());
  }
  template <typename T>
  T & own()
  {
    if (shared_.use_count() != 1) {
      shared_ = std::make_shared<T>(get<T>());
    }
    return *static_cast<T *>(shared_.get());
  }

  Type type_ = Type::none;
  union {
    bool boolean;
    std::int32_t integer;
    double floating = 0.0;
  } scalar_;
  std::shared_ptr<void> shared_;  ///< of the type that type_ says, null for scalars
};

struct Structure {
  std::vector<std::pair<std::string, Value>> members;

  Value * find(std::string_view name);
  const Value * find(std::string_view name) const;
};

/// Equality in URScript: int, float and bool compare by value; containers by element.
bool equal(const Value & left, const Value & right);

}  // namespace ur_simulator::urscript
