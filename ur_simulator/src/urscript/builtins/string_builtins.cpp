#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include "urscript/argument_reader.hpp"
#include "urscript/builtins/builtins.hpp"

namespace ur_simulator::urscript {

namespace {

constexpr std::size_t formatted_limit = 1023;  // characters, of to_str() and str_cat() (script manual)

Outcome formatted(std::string text)
{
  if (text.size() > formatted_limit) {
    return Failure{fmt::format("the string has {} characters, more than {}", text.size(), formatted_limit)};
  }
  return Value(std::move(text));
}

Outcome str_at(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string source = reader.string(0, "src");
  const std::int32_t index = reader.integer(1, "index");
  reader.require(
      index >= 0 && static_cast<std::size_t>(index) < source.size(),
      fmt::format("index must be in [0, {}], is {}", static_cast<std::int64_t>(source.size()) - 1, index));
  return reader ? Outcome(Value(std::string(1, source[static_cast<std::size_t>(index)]))) : reader.failure();
}

Outcome str_cat(CallContext &, Arguments arguments)
{
  std::string result;
  for (const Value & part : arguments) {
    result += part.text();
  }
  return formatted(std::move(result));
}

// The position of `target`, or -1. The time of memmem() is linear; that of std::string::find() is quadratic
// in the worst case, longer than a control cycle.
std::int32_t find_text(const std::string & source, const std::string & target, std::size_t start)
{
  if (start > source.size()) {
    return -1;
  }
  const void * found = memmem(source.data() + start, source.size() - start, target.data(), target.size());
  return found == nullptr ? -1 : static_cast<std::int32_t>(static_cast<const char *>(found) - source.data());
}

Outcome str_find(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string source = reader.string(0, "src");
  const std::string target = reader.string(1, "target");
  const std::int32_t start = reader.integer(2, "start_from");
  reader.require(start >= 0, "start_from must not be negative");
  if (!reader) {
    return reader.failure();
  }
  return Value(find_text(source, target, static_cast<std::size_t>(start)));
}

Outcome str_sub(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string source = reader.string(0, "src");
  const std::int32_t index = reader.integer(1, "index");
  const bool to_end = !reader.given(2);
  const std::int32_t length = to_end ? 0 : reader.integer(2, "len");
  reader.require(length >= 0, fmt::format("len must not be negative, is {}", length));
  reader.require(index >= 0 && static_cast<std::size_t>(index) <= source.size(),
                 fmt::format("index must be in [0, {}], is {}", source.size(), index));
  if (!reader) {
    return reader.failure();
  }
  return Value(source.substr(static_cast<std::size_t>(index),
                             to_end ? std::string::npos : static_cast<std::size_t>(length)));
}

// An integer, unless the text has a decimal point or an exponent, or is "inf" or "nan".
Outcome to_num(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string text = reader.string(0, "str");
  char * end = nullptr;
  errno = 0;
  const double number = std::strtod(text.c_str(), &end);
  const bool overflow = errno == ERANGE && std::isinf(number);
  const bool hexadecimal = text.find_first_of("xX") != std::string::npos;
  const bool whole = text.find_first_of(hexadecimal ? "." : ".eEnN") == std::string::npos;
  reader.require(!text.empty() && *end == '\0', fmt::format("'{}' is not a number", text));
  reader.require(!overflow, fmt::format("'{}' is out of the range of a float", text));
  reader.require(!whole || (number >= std::numeric_limits<std::int32_t>::min() &&
                            number <= std::numeric_limits<std::int32_t>::max()),
                 fmt::format("'{}' is out of the range of an int", text));
  if (!reader) {
    return reader.failure();
  }
  return whole ? Value(static_cast<std::int32_t>(number)) : Value(number);
}

Outcome str_len(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const auto length = static_cast<std::int32_t>(reader.string(0, "str").size());
  return reader ? Outcome(Value(length)) : reader.failure();
}

Outcome str_empty(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const bool empty = reader.string(0, "str").empty();
  return reader ? Outcome(Value(empty)) : reader.failure();
}

}  // namespace

void add_string_builtins(Library & library)
{
  library.add({"str_at", {"src", "index"}, 2, str_at});
  library.add({"str_cat", {"op1", "op2"}, 2, str_cat});
  library.add({"str_find", {"src", "target", {"start_from", Value(0)}}, 2, str_find});
  library.add({"str_sub", {"src", "index", "len"}, 2, str_sub});
  library.add({"str_len", {"str"}, 1, str_len});
  library.add({"str_empty", {"str"}, 1, str_empty});
  library.add({"to_num", {"str"}, 1, to_num});
  library.add({"to_str", {"val"}, 1, [](CallContext &, Arguments arguments) -> Outcome {
                 return formatted(arguments[0].text());
               }});
}

}  // namespace ur_simulator::urscript
