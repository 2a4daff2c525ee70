#include <cstdlib>

#include "urscript/argument_reader.hpp"
#include "urscript/builtins.hpp"
#include "urscript/containers.hpp"

namespace ur_simulator::urscript {

namespace {

Outcome str_at(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::string source = in.string(0, "src");
  const std::int32_t index = in.integer(1, "index");
  in.require(index >= 0 && static_cast<std::size_t>(index) < source.size(),
             fmt::format("index {} is outside of the string of {} bytes", index, source.size()));
  return in ? Outcome(Value(std::string(1, source[static_cast<std::size_t>(index)]))) : in.failure();
}

Outcome str_cat(CallContext &, Arguments arguments)
{
  std::string result;
  for (const Value & part : arguments) {
    result += part.text();
  }
  if (result.size() > string_limit) {
    return Failure{fmt::format("the string is longer than {} bytes", string_limit)};
  }
  return Value(std::move(result));
}

Outcome str_find(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::string source = in.string(0, "src");
  const std::string target = in.string(1, "target");
  const std::int32_t start = in.integer(2, "start_from");
  in.require(start >= 0, "start_from must not be negative");
  const std::size_t found = source.find(target, static_cast<std::size_t>(std::max(start, 0)));
  return in ? Outcome(Value(found == std::string::npos ? -1 : static_cast<std::int32_t>(found)))
            : in.failure();
}

Outcome str_sub(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::string source = in.string(0, "src");
  const std::int32_t index = in.integer(1, "index");
  const std::int32_t length = in.given(2) ? in.integer(2, "len") : -1;
  in.require(index >= 0 && static_cast<std::size_t>(index) <= source.size(),
             fmt::format("index {} is outside of the string of {} bytes", index, source.size()));
  if (!in) {
    return in.failure();
  }
  return Value(source.substr(static_cast<std::size_t>(index),
                             length < 0 ? std::string::npos : static_cast<std::size_t>(length)));
}

Outcome to_num(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::string text = in.string(0, "str");
  char * end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  in.require(!text.empty() && *end == '\0' && std::isfinite(number),
             fmt::format("'{}' is not a number", text));
  if (!in) {
    return in.failure();
  }
  const bool whole = text.find_first_of(".eE") == std::string::npos && std::abs(number) <= 2147483647.0;
  return whole ? Value(static_cast<std::int32_t>(number)) : Value(number);
}

Outcome str_len(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const auto length = static_cast<std::int32_t>(in.string(0, "str").size());
  return in ? Outcome(Value(length)) : in.failure();
}

Outcome str_empty(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const bool empty = in.string(0, "str").empty();
  return in ? Outcome(Value(empty)) : in.failure();
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
                 return Value(arguments[0].text());
               }});
}

}  // namespace ur_simulator::urscript
