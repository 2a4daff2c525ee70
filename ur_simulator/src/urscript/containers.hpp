#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "urscript/code.hpp"
#include "urscript/operators.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// What one value may hold, everything in it counted. Keeps every instruction short and a hostile program
/// small.
constexpr std::size_t element_limit = 10000;
constexpr std::size_t string_limit = 16384;

/// `[a, b, …]`: a matrix when all elements are lists of numbers of one length.
Result make_list(std::span<Value> elements);
/// `p[…]` from six numbers.
Result make_pose(std::span<const Value> elements);
Result make_structure(const std::vector<std::string> & shape, std::span<Value> members);

/// container[i] or container[row, column].
Result element(const Value & container, std::span<const Value> indices);
Result member(const Value & structure, const std::string & name);

/// Follows a path from a variable to a part that has storage of its own (not a pose's or matrix's number) for
/// all steps but `last`.
tl::expected<Value *, std::string> follow(Value & variable, const Path & path, std::span<const Value> indices,
                                          std::size_t steps);
/// variable.path = value
tl::expected<void, std::string> assign(Value & variable, const Path & path, std::span<const Value> indices,
                                       Value value);

/// object.method(arguments): length, append, pop, insert, remove, clear, extend, slice, capacity, to_string.
Result call_method(Value & object, const std::string & method, std::span<const Value> arguments);

/// How many elements a value holds, counted up to just above `element_limit`; above it too when nested too
/// deeply.
std::size_t weight(const Value & value, std::size_t depth = 0);

}  // namespace ur_simulator::urscript
