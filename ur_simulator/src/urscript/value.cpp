#include "urscript/value.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace ur_simulator::urscript {

namespace {

// Values may share storage, so that their text can be much larger than their memory.
constexpr std::size_t text_limit = 16384;

/// Six decimals, without trailing zeros.
std::string fixed_text(double value)
{
  std::string text = fmt::format("{:.6f}", value);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    text.erase(text.find_last_not_of('.') + 1);
  }
  return text == "-0" ? "0" : text;
}

class TextWriter {
 public:
  explicit TextWriter(TextFormat format) : format_(format) {}

  void append(const Value & value, bool nested)
  {
    if (is_full()) {
      return;
    }
    switch (value.type()) {
      case Type::none:
        out_ += "None";
        return;
      case Type::boolean:
        out_ += value.boolean() ? "True" : "False";
        return;
      case Type::integer:
        out_ += std::to_string(value.integer());
        return;
      case Type::floating:
        append(value.floating());
        return;
      case Type::string:
        out_ += nested ? "\"" : "";
        out_ += value.string();
        out_ += nested ? "\"" : "";
        return;
      case Type::pose:
        out_ += "p[";
        append_elements(value.pose(), format_ == TextFormat::message ? "," : ", ");
        out_ += ']';
        return;
      case Type::list:
        out_ += '[';
        append_elements(value.list(), ", ");
        out_ += ']';
        return;
      case Type::matrix:
        append(value.matrix());
        return;
      case Type::structure:
        append(value.structure());
        return;
      case Type::remote:
        out_ += "RPC";
        return;
    }
  }

  std::string take()
  {
    if (is_full()) {
      out_.resize(text_limit);
      out_ += "...";
    }
    return std::move(out_);
  }

 private:
  bool is_full() const { return out_.size() > text_limit; }

  void append(double value)
  {
    out_ += format_ == TextFormat::message ? fmt::format("{:g}", value) : fixed_text(value);
  }

  template <typename Elements>
  void append_elements(const Elements & elements, const char * separator)
  {
    bool first = true;
    for (const auto & element : elements) {
      out_ += first ? "" : separator;
      first = false;
      append(Value(element), true);
      if (is_full()) {
        return;
      }
    }
  }

  void append(const Matrix & matrix)
  {
    for (std::size_t row = 0; row < matrix.rows && !is_full(); ++row) {
      out_ += row == 0 ? "[[" : ", [";
      for (std::size_t column = 0; column < matrix.columns && !is_full(); ++column) {
        out_ += column == 0 ? "" : ", ";
        append(matrix.at(row, column));
      }
      out_ += ']';
    }
    out_ += ']';
  }

  void append(const Structure & structure)
  {
    out_ += "struct(";
    bool first = true;
    for (const auto & [name, member] : structure.members) {
      out_ += first ? "" : ", ";
      out_ += name;
      out_ += '=';
      first = false;
      append(member, true);
    }
    out_ += ')';
  }

  TextFormat format_;
  std::string out_;
};

bool equal_lists(const List & left, const List & right)
{
  if (left.size() != right.size()) {
    return false;
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!equal(left[i], right[i])) {
      return false;
    }
  }
  return true;
}

bool equal_structures(const Structure & left, const Structure & right)
{
  if (left.members.size() != right.members.size()) {
    return false;
  }
  for (std::size_t i = 0; i < left.members.size(); ++i) {
    if (left.members[i].first != right.members[i].first ||
        !equal(left.members[i].second, right.members[i].second)) {
      return false;
    }
  }
  return true;
}

template <typename VectorN>
std::optional<VectorN> to_vector(const Value & value)
{
  constexpr auto size = static_cast<std::size_t>(VectorN::RowsAtCompileTime);
  if (!value.is(Type::list) || value.list().size() != size) {
    return std::nullopt;
  }
  VectorN result;
  for (std::size_t i = 0; i < size; ++i) {
    const Value & element = value.list()[i];
    if (!element.is_number()) {
      return std::nullopt;
    }
    result[static_cast<Eigen::Index>(i)] = *element.number();
  }
  return result;
}

}  // namespace

std::string_view name_of(Type type)
{
  constexpr std::array<std::string_view, 10> names{"none", "bool", "int",    "float",  "string",
                                                   "pose", "list", "matrix", "struct", "RPC handle"};
  return names[static_cast<std::size_t>(type)];
}

Value::Value(std::string value) : Value(Type::string, std::make_shared<std::string>(std::move(value))) {}
Value::Value(const char * value) : Value(std::string(value)) {}
Value::Value(List value) : Value(Type::list, std::make_shared<List>(std::move(value))) {}
Value::Value(Matrix value) : Value(Type::matrix, std::make_shared<Matrix>(std::move(value))) {}
Value::Value(Structure value) : Value(Type::structure, std::make_shared<Structure>(std::move(value))) {}
Value::Value(std::shared_ptr<RemoteObject> object) : Value(Type::remote, std::move(object)) {}

Value Value::pose(const Vector6 & pose)
{
  return {Type::pose, std::make_shared<Vector6>(pose)};
}

Value Value::list(const Vector6 & values)
{
  return List(values.begin(), values.end());
}
Value Value::list(const Vector3 & values)
{
  return List(values.begin(), values.end());
}

std::optional<double> Value::number() const
{
  switch (type()) {
    case Type::boolean:
      return boolean() ? 1.0 : 0.0;
    case Type::integer:
      return integer();
    case Type::floating:
      return floating();
    default:
      return std::nullopt;
  }
}

std::optional<Vector6> Value::vector6() const
{
  return is(Type::pose) ? std::optional<Vector6>(pose()) : to_vector<Vector6>(*this);
}

std::optional<Vector3> Value::vector3() const
{
  return to_vector<Vector3>(*this);
}

std::string Value::text(TextFormat format) const
{
  TextWriter writer(format);
  writer.append(*this, false);
  return writer.take();
}

Value * Structure::find(std::string_view name)
{
  for (auto & [member, value] : members) {
    if (member == name) {
      return &value;
    }
  }
  return nullptr;
}

const Value * Structure::find(std::string_view name) const
{
  return const_cast<Structure *>(this)->find(name);
}

bool equal(const Value & left, const Value & right)
{
  const auto a = left.number();
  const auto b = right.number();
  if (a && b) {
    return *a == *b;
  }
  if (left.type() != right.type()) {
    return false;
  }
  switch (left.type()) {
    case Type::string:
      return left.string() == right.string();
    case Type::pose:
      return left.pose() == right.pose();
    case Type::list:
      return &left.list() == &right.list() || equal_lists(left.list(), right.list());
    case Type::matrix:
      return left.matrix() == right.matrix();
    case Type::structure:
      return equal_structures(left.structure(), right.structure());
    case Type::remote:
      return &left.remote() == &right.remote();
    default:
      return true;
  }
}

}  // namespace ur_simulator::urscript
