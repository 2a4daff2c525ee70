#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "urscript/argument_reader.hpp"
#include "urscript/builtins/builtins.hpp"
#include "urscript/interpreter/containers.hpp"

namespace ur_simulator::urscript {

namespace {

std::int32_t count(std::size_t size)
{
  return static_cast<std::int32_t>(size);
}

Outcome list_length(CallContext &, Arguments arguments)
{
  const Value & v = arguments[0];
  switch (v.type()) {
    case Type::list:
      return Value(count(v.list().size()));
    case Type::string:
      return Value(count(v.string().size()));
    case Type::pose:
      return Value(6);
    case Type::matrix:
      return Value(count(v.matrix().rows));
    default:
      return Failure{fmt::format("the argument 'v' must be a list, not {}", name_of(v.type()))};
  }
}

Outcome size(CallContext & context, Arguments arguments)
{
  const Value & v = arguments[0];
  if (v.is(Type::matrix)) {
    return Value(List{Value(count(v.matrix().rows)), Value(count(v.matrix().columns))});
  }
  return list_length(context, arguments);
}

Outcome transpose(CallContext &, Arguments arguments)
{
  if (!arguments[0].is(Type::matrix)) {
    return Failure{"the argument 'm' must be a matrix"};
  }
  const Matrix & m = arguments[0].matrix();
  Matrix result{m.columns, m.rows, std::vector<double>(m.elements.size())};
  for (std::size_t row = 0; row < m.rows; ++row) {
    for (std::size_t column = 0; column < m.columns; ++column) {
      result.at(column, row) = m.at(row, column);
    }
  }
  return Value(std::move(result));
}

Outcome inverse(const Matrix & m)
{
  using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  // The effort is cubic; larger matrices would take longer than a cycle.
  constexpr std::size_t largest = 32;
  if (m.rows != m.columns || m.rows > largest) {
    return Failure{fmt::format("the matrix must be square and at most {}x{}, is {}x{}", largest, largest,
                               m.rows, m.columns)};
  }
  const auto size = static_cast<Eigen::Index>(m.rows);
  const Dense dense = Eigen::Map<const Dense>(m.elements.data(), size, size);
  const Eigen::FullPivLU<Dense> decomposition(dense);
  if (!decomposition.isInvertible()) {
    return Failure{"the matrix is singular"};
  }
  const Dense inverted = decomposition.inverse();
  return Value(
      Matrix{m.rows, m.columns, std::vector<double>(inverted.data(), inverted.data() + inverted.size())});
}

Outcome binary_list_to_integer(CallContext &, Arguments arguments)
{
  constexpr std::size_t places = 32;  // further elements have no effect (script manual)
  if (!arguments[0].is(Type::list)) {
    return Failure{"the argument 'l' must be a list of bools"};
  }
  std::uint32_t bits = 0;
  const List & list = arguments[0].list();
  for (std::size_t place = 0; place < std::min(places, list.size()); ++place) {
    const auto set = to_condition(list[place]);
    if (!set) {
      return Failure{"the argument 'l' must be a list of bools"};
    }
    bits |= (*set ? 1U : 0U) << place;
  }
  return Value(static_cast<std::int32_t>(bits));
}

Outcome integer_to_binary_list(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const auto bits = static_cast<std::uint32_t>(reader.integer(0, "x"));
  List list;
  for (std::uint32_t place = 0; place < 32; ++place) {
    list.emplace_back(((bits >> place) & 1U) != 0);
  }
  return reader ? Outcome(Value(std::move(list))) : reader.failure();
}

Outcome normalize(CallContext &, Arguments arguments)
{
  if (!arguments[0].is(Type::list)) {
    return Failure{
        fmt::format("the argument 'v' must be a list of numbers, not {}", name_of(arguments[0].type()))};
  }
  double square = 0.0;
  for (const Value & element : arguments[0].list()) {
    const auto number = element.is_number() ? element.number() : std::nullopt;
    if (!number) {
      return Failure{"the argument 'v' must be a list of numbers"};
    }
    square += *number * *number;
  }
  if (!(square > 0.0) || !std::isfinite(square)) {
    return Failure{"the list has no direction: its norm must be positive and finite"};
  }
  List result;
  for (const Value & element : arguments[0].list()) {
    result.emplace_back(*element.number() / std::sqrt(square));
  }
  return Value(std::move(result));
}

Outcome make_list_builtin(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t requested = reader.integer(0, "length");
  const Value initial = reader.given(1) ? reader.value(1) : Value(0);
  const std::size_t length = static_cast<std::size_t>(std::max(requested, 0));
  reader.require(requested >= 0 && length * element_count(initial) <= element_limit,
                 fmt::format("length must be in [0, {}], is {}", element_limit, requested));
  return reader ? Outcome(Value(List(length, initial))) : reader.failure();
}

}  // namespace

void add_list_builtins(Library & library)
{
  library.add({"normalize", {"v"}, 1, normalize});
  library.add({"get_list_length", {"v"}, 1, list_length});
  library.add({"length", {"v"}, 1, list_length});
  library.add({"size", {"v"}, 1, size});
  library.add({"transpose", {"m"}, 1, transpose});
  library.add({"binary_list_to_integer", {"l"}, 1, binary_list_to_integer});
  library.add({"integer_to_binary_list", {"x"}, 1, integer_to_binary_list});
  library.add({"make_list", {"length", "initial_value", "capacity"}, 1, make_list_builtin});
  const auto pose_inverse = library[*library.find("pose_inv")].function;
  library.add({"inv", {"m"}, 1, [pose_inverse](CallContext & context, Arguments arguments) -> Outcome {
                 if (arguments[0].is(Type::matrix)) {
                   return inverse(arguments[0].matrix());
                 }
                 return pose_inverse(context, arguments);
               }});
}

}  // namespace ur_simulator::urscript
