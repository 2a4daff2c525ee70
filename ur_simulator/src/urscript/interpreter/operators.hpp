#pragma once

#include <string>
#include <tl/expected.hpp>

#include "urscript/parser/syntax.hpp"
#include "urscript/value.hpp"

namespace ur_simulator::urscript {

using Result = tl::expected<Value, std::string>;

/// Binary operators except logical_and and logical_or, which do not evaluate both sides. Integers remain
/// integers under + - * and %, and wrap at 32 bits; / always returns a float. Lists and matrices follow
/// "Matrix and Array Expressions" of the script manual: element-wise; matrix times matrix and matrix times
/// array are matrix products. + concatenates strings.
Result binary(Operator op, const Value & left, const Value & right);
/// Fast path for two numbers and operators that cannot fail: stores the result in `left`. Returns false
/// otherwise; then use binary().
bool apply_to_scalars(Operator op, Value & left, const Value & right);
Result negate(const Value & value);
/// The value of a condition: a bool, whether a number is not zero, or whether a string is not empty.
tl::expected<bool, std::string> to_condition(const Value & value);
std::string_view symbol_of(Operator op);

}  // namespace ur_simulator::urscript
