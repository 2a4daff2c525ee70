#pragma once

#include <string>
#include <tl/expected.hpp>

#include "urscript/syntax.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

using Result = tl::expected<Value, std::string>;

/// The operators of the language, logical_and and logical_or apart (they do not evaluate both sides).
/// Integers stay integers under
/// + - * and %, and wrap at 32 bit; / always gives a float. Lists of numbers and matrices as in "Matrix and
/// Array Expressions" of the script manual: element by element, matrix by matrix and matrix by array as
/// products. + joins strings.
Result binary(Operator op, const Value & left, const Value & right);
/// The frequent cases, numbers on both sides and nothing that can go wrong: `left` becomes the result. False:
/// use binary().
bool combine_scalars(Operator op, Value & left, const Value & right);
Result negate(const Value & value);
/// Of a condition: a bool, or a number that is not zero.
tl::expected<bool, std::string> truth(const Value & value);
std::string_view symbol_of(Operator op);

}  // namespace ur_simulator::urscript
