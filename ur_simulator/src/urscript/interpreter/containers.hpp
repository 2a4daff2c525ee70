#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "urscript/compiler/code.hpp"
#include "urscript/interpreter/operators.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// Limits of one value, nested elements included. They bound the time of an instruction and the memory of a
/// program.
constexpr std::size_t element_limit = 10000;
constexpr std::size_t string_limit = 16384;

/// `[a, b, …]`: a matrix if all elements are lists of numbers of equal length.
Result make_list(std::span<Value> elements);
/// `p[…]` from six numbers.
Result make_pose(std::span<const Value> elements);
Result make_structure(const std::vector<std::string> & member_names, std::span<Value> members);

/// container[i] or container[row, column].
Result element(const Value & container, std::span<const Value> indices);
Result member(const Value & structure, const std::string & name);

/// Resolves the first `steps` steps of an lvalue. The numbers of poses and matrices are no values of their
/// own; they cannot be resolved.
tl::expected<Value *, std::string> follow(Value & variable, const Lvalue & lvalue,
                                          std::span<const Value> indices, std::size_t steps);
/// Assigns to an lvalue.
tl::expected<void, std::string> assign(Value & variable, const Lvalue & lvalue,
                                       std::span<const Value> indices, Value value);

/// object.method(arguments): length, append, pop, insert, remove, clear, extend, slice, capacity, to_string.
Result call_method(Value & object, const std::string & method, std::span<const Value> arguments);

/// Number of elements in a value, nested ones included. Counting stops above `element_limit`; a value that is
/// nested too deeply also counts as above.
std::size_t element_count(const Value & value, std::size_t depth = 0);

}  // namespace ur_simulator::urscript
