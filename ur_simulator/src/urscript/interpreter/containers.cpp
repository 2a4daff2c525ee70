#include "urscript/interpreter/containers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ur_simulator::urscript {

namespace {

tl::unexpected<std::string> too_large()
{
  return tl::unexpected(
      fmt::format("a value must have at most {} elements and must not be nested too deeply", element_limit));
}

bool is_row(const Value & value, std::size_t columns)
{
  return value.is(Type::list) && value.list().size() == columns &&
         std::all_of(value.list().begin(), value.list().end(), [](const Value & e) { return e.is_number(); });
}

bool forms_matrix(std::span<const Value> rows)
{
  if (rows.empty() || !rows.front().is(Type::list) || rows.front().list().empty()) {
    return false;
  }
  const std::size_t columns = rows.front().list().size();
  return std::all_of(rows.begin(), rows.end(), [&](const Value & row) { return is_row(row, columns); });
}

Value to_matrix(std::span<const Value> rows)
{
  Matrix matrix{rows.size(), rows.front().list().size(), {}};
  matrix.elements.reserve(matrix.rows * matrix.columns);
  for (const Value & row : rows) {
    for (const Value & element : row.list()) {
      matrix.elements.push_back(*element.number());
    }
  }
  return matrix;
}

tl::expected<std::size_t, std::string> checked_index(const Value & index, std::size_t size, const char * of)
{
  if (!index.is(Type::integer)) {
    return tl::unexpected(
        fmt::format("Type error: the index of a {} must be an int, not {}", of, name_of(index.type())));
  }
  if (index.integer() < 0 || static_cast<std::size_t>(index.integer()) >= size) {
    return tl::unexpected(
        fmt::format("index {} is out of range: the {} has {} elements", index.integer(), of, size));
  }
  return static_cast<std::size_t>(index.integer());
}

// The number in a pose or matrix at these indices.
tl::expected<double *, std::string> number_at(Value & container, std::span<const Value> indices)
{
  if (container.is(Type::pose) && indices.size() == 1) {
    return checked_index(indices[0], 6, "pose").map([&](std::size_t i) {
      return &container.own_pose()[static_cast<Eigen::Index>(i)];
    });
  }
  if (container.is(Type::matrix) && indices.size() == 2) {
    const auto row = checked_index(indices[0], container.matrix().rows, "matrix");
    if (!row) {
      return tl::unexpected(row.error());
    }
    return checked_index(indices[1], container.matrix().columns, "matrix").map([&](std::size_t column) {
      return &container.own_matrix().at(*row, column);
    });
  }
  return tl::unexpected(
      fmt::format("Type error: {} indices do not fit a {}", indices.size(), name_of(container.type())));
}

Result row_of(const Matrix & matrix, const Value & index)
{
  return checked_index(index, matrix.rows, "matrix").map([&](std::size_t row) {
    const auto begin = matrix.elements.begin() + static_cast<std::ptrdiff_t>(row * matrix.columns);
    return Value(List(begin, begin + static_cast<std::ptrdiff_t>(matrix.columns)));
  });
}

tl::expected<Value *, std::string> element_slot(Value & container, const LvalueStep & step,
                                                std::span<const Value> indices)
{
  if (step.indices == 0) {
    Value * found = container.is(Type::structure) ? container.own_structure().find(step.member) : nullptr;
    if (found == nullptr) {
      return tl::unexpected(fmt::format("the {} has no member '{}'", name_of(container.type()), step.member));
    }
    return found;
  }
  if (!container.is(Type::list) || step.indices != 1) {
    return tl::unexpected(
        fmt::format("Type error: {} indices do not fit a {}", step.indices, name_of(container.type())));
  }
  return checked_index(indices.front(), container.list().size(), "list").map([&](std::size_t i) {
    return &container.own_list()[i];
  });
}

}  // namespace

std::size_t element_count(const Value & value, std::size_t depth)
{
  constexpr std::size_t depth_limit = 16;
  if (depth > depth_limit) {
    return element_limit + 1;
  }
  std::size_t sum = 1;
  if (value.is(Type::list)) {
    for (const Value & element : value.list()) {
      sum += element_count(element, depth + 1);
      if (sum > element_limit) {
        break;
      }
    }
  } else if (value.is(Type::structure)) {
    for (const auto & [name, inner] : value.structure().members) {
      sum += element_count(inner, depth + 1);
      if (sum > element_limit) {
        break;
      }
    }
  } else if (value.is(Type::matrix)) {
    sum += value.matrix().elements.size();
  }
  return sum;
}

Result make_list(std::span<Value> elements)
{
  if (forms_matrix(elements)) {
    return to_matrix(elements);
  }
  Value list(List(std::make_move_iterator(elements.begin()), std::make_move_iterator(elements.end())));
  if (element_count(list) > element_limit) {
    return too_large();
  }
  return list;
}

Result make_pose(std::span<const Value> elements)
{
  Vector6 pose;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!elements[i].is_number()) {
      return tl::unexpected(
          fmt::format("Type error: a pose takes numbers, not {}", name_of(elements[i].type())));
    }
    pose[static_cast<Eigen::Index>(i)] = *elements[i].number();
  }
  return Value::pose(pose);
}

Result make_structure(const std::vector<std::string> & member_names, std::span<Value> members)
{
  Structure structure;
  for (std::size_t i = 0; i < member_names.size(); ++i) {
    structure.members.emplace_back(member_names[i], std::move(members[i]));
  }
  Value value(std::move(structure));
  if (element_count(value) > element_limit) {
    return too_large();
  }
  return value;
}

Result element(const Value & container, std::span<const Value> indices)
{
  const std::size_t count = indices.size();
  if (container.is(Type::list) && count == 1) {
    return checked_index(indices[0], container.list().size(), "list").map([&](std::size_t i) {
      return container.list()[i];
    });
  }
  if (container.is(Type::pose) && count == 1) {
    return checked_index(indices[0], 6, "pose").map([&](std::size_t i) {
      return Value(container.pose()[static_cast<Eigen::Index>(i)]);
    });
  }
  if (container.is(Type::matrix) && count == 1) {
    return row_of(container.matrix(), indices[0]);
  }
  if (container.is(Type::matrix) && count == 2) {
    const Matrix & matrix = container.matrix();
    const auto row = checked_index(indices[0], matrix.rows, "matrix");
    if (!row) {
      return tl::unexpected(row.error());
    }
    return checked_index(indices[1], matrix.columns, "matrix").map([&](std::size_t c) {
      return Value(matrix.at(*row, c));
    });
  }
  return tl::unexpected(
      fmt::format("Type error: {} indices do not fit a {}", count, name_of(container.type())));
}

Result member(const Value & structure, const std::string & name)
{
  const Value * found = structure.is(Type::structure) ? structure.structure().find(name) : nullptr;
  if (found == nullptr) {
    return tl::unexpected(fmt::format("the {} has no member '{}'", name_of(structure.type()), name));
  }
  return *found;
}

tl::expected<Value *, std::string> follow(Value & variable, const Lvalue & lvalue,
                                          std::span<const Value> indices, std::size_t steps)
{
  Value * current = &variable;
  for (std::size_t i = 0; i < steps; ++i) {
    const LvalueStep & step = lvalue.steps[i];
    const auto next = element_slot(*current, step, indices.first(step.indices));
    if (!next) {
      return next;
    }
    current = *next;
    indices = indices.subspan(step.indices);
  }
  return current;
}

tl::expected<void, std::string> assign(Value & variable, const Lvalue & lvalue,
                                       std::span<const Value> indices, Value value)
{
  const LvalueStep & last = lvalue.steps.back();
  const auto container = follow(variable, lvalue, indices, lvalue.steps.size() - 1);
  if (!container) {
    return tl::unexpected(container.error());
  }
  const auto last_indices = indices.last(last.indices);
  if ((*container)->is(Type::pose) || (*container)->is(Type::matrix)) {
    if (!value.is_number()) {
      return tl::unexpected(fmt::format("Type error: an element of a {} is a number, not {}",
                                        name_of((*container)->type()), name_of(value.type())));
    }
    return number_at(**container, last_indices).map([&](double * number) { *number = *value.number(); });
  }
  const auto place = element_slot(**container, last, last_indices);
  if (!place) {
    return tl::unexpected(place.error());
  }
  const bool grows = value.is(Type::list) || value.is(Type::matrix) || value.is(Type::structure);
  **place = std::move(value);
  if (grows && element_count(variable) > element_limit) {
    **place = Value();
    return too_large();
  }
  return {};
}

}  // namespace ur_simulator::urscript
