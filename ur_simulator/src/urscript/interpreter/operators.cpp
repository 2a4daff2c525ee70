#include "urscript/interpreter/operators.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "urscript/interpreter/containers.hpp"

namespace ur_simulator::urscript {

namespace {

constexpr const char * division_by_zero = "division by zero";

tl::unexpected<std::string> type_error(Operator op, const Value & left, const Value & right)
{
  return tl::unexpected(fmt::format("Type error: '{}' does not take {} and {}", symbol_of(op),
                                    name_of(left.type()), name_of(right.type())));
}

bool is_comparison(Operator op)
{
  return op >= Operator::equal && op <= Operator::greater_equal;
}

template <typename Number>
bool compare(Operator op, Number left, Number right)
{
  switch (op) {
    case Operator::less:
      return left < right;
    case Operator::less_equal:
      return left <= right;
    case Operator::greater:
      return left > right;
    case Operator::greater_equal:
      return left >= right;
    case Operator::equal:
      return left == right;
    default:
      return left != right;
  }
}

// Integers wrap in two's complement.
std::int32_t wrapped(std::int64_t value)
{
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
}

Result integers(Operator op, std::int32_t left, std::int32_t right)
{
  const std::int64_t wide = left;
  switch (op) {
    case Operator::add:
      return wrapped(wide + right);
    case Operator::subtract:
      return wrapped(wide - right);
    case Operator::multiply:
      return wrapped(wide * right);
    case Operator::divide:
      return right == 0 ? Result(tl::unexpected<std::string>(division_by_zero))
                        : Result(Value(double(left) / right));
    default:
      return right == 0 ? Result(tl::unexpected<std::string>(division_by_zero))
                        : Result(Value(wrapped(wide % right)));
  }
}

Result floats(Operator op, double left, double right)
{
  switch (op) {
    case Operator::add:
      return Value(left + right);
    case Operator::subtract:
      return Value(left - right);
    case Operator::multiply:
      return Value(left * right);
    default:
      break;
  }
  if (right == 0.0) {
    return tl::unexpected<std::string>(division_by_zero);
  }
  return Value(op == Operator::divide ? left / right : std::fmod(left, right));
}

Result numbers(Operator op, const Value & left, const Value & right)
{
  if (left.is(Type::integer) && right.is(Type::integer)) {
    return integers(op, left.integer(), right.integer());
  }
  return floats(op, *left.number(), *right.number());
}

bool is_array(const Value & value)
{
  return value.is(Type::list);
}

Result lists(Operator op, const List & left, const List & right)
{
  if (left.size() != right.size()) {
    return tl::unexpected(fmt::format("'{}' of lists of different lengths: {} and {}", symbol_of(op),
                                      left.size(), right.size()));
  }
  List result(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i].is_number() || !right[i].is_number()) {
      return type_error(op, left[i], right[i]);
    }
    Result element = numbers(op, left[i], right[i]);
    if (!element) {
      return element;
    }
    result[i] = std::move(*element);
  }
  return Value(std::move(result));
}

Result list_and_scalar(Operator op, const List & list, const Value & scalar, bool scalar_left)
{
  List result(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_number()) {
      return type_error(op, list[i], scalar);
    }
    Result element = scalar_left ? numbers(op, scalar, list[i]) : numbers(op, list[i], scalar);
    if (!element) {
      return element;
    }
    result[i] = std::move(*element);
  }
  return Value(std::move(result));
}

Result matrix_and_scalar(Operator op, const Matrix & matrix, double scalar, bool scalar_left)
{
  Matrix result = matrix;
  for (double & element : result.elements) {
    Result value = scalar_left ? floats(op, scalar, element) : floats(op, element, scalar);
    if (!value) {
      return value;
    }
    element = value->floating();
  }
  return Value(std::move(result));
}

Result product(const Matrix & left, const Matrix & right)
{
  if (left.columns != right.rows) {
    return tl::unexpected(fmt::format("a {}x{} matrix cannot be multiplied by a {}x{} one", left.rows,
                                      left.columns, right.rows, right.columns));
  }
  // Limits the computing time and the size of the result.
  if (left.rows * right.columns * left.columns > element_limit * 10) {
    return tl::unexpected<std::string>("the matrices are too large to multiply");
  }
  Matrix result{left.rows, right.columns, std::vector<double>(left.rows * right.columns, 0.0)};
  for (std::size_t row = 0; row < left.rows; ++row) {
    for (std::size_t column = 0; column < right.columns; ++column) {
      for (std::size_t i = 0; i < left.columns; ++i) {
        result.at(row, column) += left.at(row, i) * right.at(i, column);
      }
    }
  }
  return Value(std::move(result));
}

Result matrices(Operator op, const Matrix & left, const Matrix & right)
{
  if (op == Operator::multiply) {
    return product(left, right);
  }
  if ((op != Operator::add && op != Operator::subtract) || left.rows != right.rows ||
      left.columns != right.columns) {
    return tl::unexpected(fmt::format("'{}' does not take a {}x{} and a {}x{} matrix", symbol_of(op),
                                      left.rows, left.columns, right.rows, right.columns));
  }
  Matrix result = left;
  for (std::size_t i = 0; i < result.elements.size(); ++i) {
    result.elements[i] += op == Operator::add ? right.elements[i] : -right.elements[i];
  }
  return Value(std::move(result));
}

Result matrix_and_array(const Matrix & matrix, const List & array)
{
  Matrix column{array.size(), 1, {}};
  for (const Value & element : array) {
    if (!element.is_number()) {
      return type_error(Operator::multiply, Value(matrix), element);
    }
    column.elements.push_back(*element.number());
  }
  Result result = product(matrix, column);
  if (!result) {
    return result;
  }
  const std::vector<double> & elements = result->matrix().elements;
  return Value(List(elements.begin(), elements.end()));
}

Result containers(Operator op, const Value & left, const Value & right)
{
  if (is_array(left) && is_array(right)) {
    return lists(op, left.list(), right.list());
  }
  if (is_array(left) && right.is_number()) {
    return list_and_scalar(op, left.list(), right, false);
  }
  if (left.is_number() && is_array(right)) {
    return list_and_scalar(op, right.list(), left, true);
  }
  if (left.is(Type::matrix) && right.is(Type::matrix)) {
    return matrices(op, left.matrix(), right.matrix());
  }
  if (left.is(Type::matrix) && right.is_number()) {
    return matrix_and_scalar(op, left.matrix(), *right.number(), false);
  }
  if (left.is_number() && right.is(Type::matrix)) {
    return matrix_and_scalar(op, right.matrix(), *left.number(), true);
  }
  if (left.is(Type::matrix) && is_array(right) && op == Operator::multiply) {
    return matrix_and_array(left.matrix(), right.list());
  }
  return type_error(op, left, right);
}

}  // namespace

std::string_view symbol_of(Operator op)
{
  constexpr std::array<std::string_view, 14> symbols{
      "or", "xor", "and", "==", "!=", "<", "<=", ">", ">=", "+", "-", "*", "/", "%"};
  return symbols[static_cast<std::size_t>(op)];
}

Result binary(Operator op, const Value & left, const Value & right)
{
  if (is_comparison(op)) {
    if (op == Operator::equal || op == Operator::not_equal) {
      return Value(equal(left, right) == (op == Operator::equal));
    }
    const auto a = left.number();
    const auto b = right.number();
    return a && b ? Result(Value(compare(op, *a, *b))) : Result(type_error(op, left, right));
  }
  if (op == Operator::logical_xor) {
    const auto a = to_condition(left);
    const auto b = to_condition(right);
    return a && b ? Result(Value(*a != *b)) : Result(type_error(op, left, right));
  }
  if (left.is_number() && right.is_number()) {
    return numbers(op, left, right);
  }
  if (op == Operator::add && left.is(Type::string) && right.is(Type::string)) {
    if (left.string().size() + right.string().size() > string_limit) {
      return tl::unexpected(fmt::format("the string is longer than {} bytes", string_limit));
    }
    return Value(left.string() + right.string());
  }
  return containers(op, left, right);
}

bool apply_to_scalars(Operator op, Value & left, const Value & right)
{
  if (!left.is_number() || !right.is_number() || op < Operator::equal || op > Operator::multiply) {
    return false;
  }
  if (left.is(Type::integer) && right.is(Type::integer)) {
    const std::int32_t a = left.integer();
    const std::int32_t b = right.integer();
    left = is_comparison(op)          ? Value(compare(op, a, b))
           : op == Operator::add      ? Value(wrapped(std::int64_t{a} + b))
           : op == Operator::subtract ? Value(wrapped(std::int64_t{a} - b))
                                      : Value(wrapped(std::int64_t{a} * b));
    return true;
  }
  const double a = left.is(Type::integer) ? left.integer() : left.floating();
  const double b = right.is(Type::integer) ? right.integer() : right.floating();
  left = is_comparison(op)          ? Value(compare(op, a, b))
         : op == Operator::add      ? Value(a + b)
         : op == Operator::subtract ? Value(a - b)
                                    : Value(a * b);
  return true;
}

Result negate(const Value & value)
{
  switch (value.type()) {
    case Type::integer:
      return Value(wrapped(-std::int64_t{value.integer()}));
    case Type::floating:
      return Value(-value.floating());
    case Type::list:
    case Type::matrix:
      return binary(Operator::multiply, Value(-1), value);
    default:
      return tl::unexpected(fmt::format("Type error: '-' does not take {}", name_of(value.type())));
  }
}

tl::expected<bool, std::string> to_condition(const Value & value)
{
  if (const auto number = value.number()) {
    return *number != 0.0;
  }
  if (value.is(Type::string)) {
    return !value.string().empty();
  }
  return tl::unexpected(fmt::format("Type error: a condition must be a bool, not {}", name_of(value.type())));
}

}  // namespace ur_simulator::urscript
