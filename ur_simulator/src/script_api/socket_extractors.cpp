#include "script_api/socket_extractors.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>

#include "urscript/interpreter/containers.hpp"

namespace ur_simulator::script_api {

namespace {

using urscript::List;
using urscript::string_limit;
using urscript::Value;

/// Of socket_read_string() (script manual).
constexpr std::size_t read_string_limit = 1024;

/// Removes and returns the bytes before `separator`, which is removed, too, or the first `limit` bytes.
std::optional<std::string> extract_until(std::string & received, std::string_view separator,
                                         std::size_t limit)
{
  const std::size_t end = received.find(separator);
  if (end > limit && received.size() > limit) {
    std::string cut = received.substr(0, limit);
    received.erase(0, limit);
    return cut;
  }
  if (end == std::string::npos) {
    return std::nullopt;
  }
  std::string text = received.substr(0, end);
  received.erase(0, end + separator.size());
  return text;
}

std::optional<std::string> extract_line(std::string & received)
{
  auto line = extract_until(received, "\n", string_limit);
  if (line && line->ends_with('\r')) {
    line->pop_back();
  }
  return line;
}

/// Reads "1.5, 2, 3"; nothing if the text is different.
std::optional<List> parse_numbers(const std::string & text)
{
  List numbers;
  const char * at = text.c_str();
  for (char * next = nullptr; *at != '\0'; at = next) {
    const double value = std::strtod(at, &next);
    if (next == at || !std::isfinite(value)) {
      return std::nullopt;
    }
    numbers.emplace_back(value);
    next += std::string_view(next).find_first_not_of(' ') == std::string_view::npos
                ? std::string_view(next).size()
                : std::string_view(next).find_first_not_of(' ');
    next += *next == ',' ? 1 : 0;
  }
  return numbers;
}

std::uint32_t big_endian(std::string_view bytes)
{
  std::uint32_t word = 0;
  for (const char byte : bytes) {
    word = word << 8 | static_cast<std::uint8_t>(byte);
  }
  return word;
}

}  // namespace

Extractor line_extractor()
{
  return [](std::string & received) -> std::optional<Value> {
    auto line = extract_line(received);
    return line ? std::optional(Value(std::move(*line))) : std::nullopt;
  };
}

Extractor string_extractor(std::string prefix, std::string suffix)
{
  return [prefix = std::move(prefix),
          suffix = std::move(suffix)](std::string & received) -> std::optional<Value> {
    const std::size_t begin = received.find(prefix);
    if (received.empty() || begin == std::string::npos) {
      const bool junk = received.size() > read_string_limit;
      received.erase(0, junk ? received.size() - prefix.size() : 0);
      return std::nullopt;
    }
    // The prefix remains until the text is complete.
    received.erase(0, begin);
    if (suffix.empty()) {
      received.erase(0, prefix.size());
      Value value(received.substr(0, read_string_limit));
      received.erase(0, read_string_limit);
      return value;
    }
    std::string rest = received.substr(prefix.size());
    auto text = extract_until(rest, suffix, read_string_limit);
    if (!text) {
      return std::nullopt;
    }
    received = std::move(rest);
    return Value(std::move(*text));
  };
}

Extractor integer_extractor(std::size_t number, std::size_t size)
{
  return [number, size](std::string & received) -> std::optional<Value> {
    if (received.size() < number * size) {
      return std::nullopt;
    }
    List values{Value(static_cast<std::int32_t>(number))};
    for (std::size_t i = 0; i < number; ++i) {
      const std::uint32_t word = big_endian(std::string_view(received).substr(i * size, size));
      values.emplace_back(static_cast<std::int32_t>(word));
    }
    received.erase(0, number * size);
    return Value(std::move(values));
  };
}

Extractor float_extractor(std::size_t number)
{
  return [number](std::string & received) -> std::optional<Value> {
    const std::size_t begin = received.find('(');
    const std::size_t end = begin == std::string::npos ? begin : received.find(')', begin);
    if (end == std::string::npos) {
      return std::nullopt;
    }
    auto values = parse_numbers(received.substr(begin + 1, end - begin - 1));
    received.erase(0, end + 1);
    if (!values || values->size() != number) {
      return failed_numbers(number, Value(std::numeric_limits<double>::quiet_NaN()));
    }
    values->insert(values->begin(), Value(static_cast<double>(number)));
    return Value(std::move(*values));
  };
}

Extractor variable_extractor(std::string name)
{
  return [name = std::move(name)](std::string & received) -> std::optional<Value> {
    const auto line = extract_line(received);
    if (!line) {
      return std::nullopt;
    }
    std::int32_t number = 0;
    if (line->starts_with(name + " ")) {
      std::from_chars(line->data() + name.size() + 1, line->data() + line->size(), number);
    }
    return Value(number);
  };
}

std::string interpret_escapes(const std::string & text)
{
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t escape =
        text[i] == '\\' && i + 1 < text.size() ? std::string("nrt").find(text[i + 1]) : std::string::npos;
    if (escape == std::string::npos) {
      result += text[i];
    } else {
      result += "\n\r\t"[escape];
      ++i;
    }
  }
  return result;
}

Value available_bytes(std::string & received, std::size_t number)
{
  const std::size_t available = std::min(number, received.size());
  List values(number + 1, Value(-1));
  values.front() = Value(static_cast<std::int32_t>(available));
  for (std::size_t i = 0; i < available; ++i) {
    values[i + 1] = Value(static_cast<std::int32_t>(static_cast<std::uint8_t>(received[i])));
  }
  received.erase(0, available);
  return values;
}

Value failed_numbers(std::size_t number, const Value & value)
{
  List list(number + 1, value);
  list.front() = value.is(urscript::Type::integer) ? Value(0) : Value(0.0);
  return Value(std::move(list));
}

}  // namespace ur_simulator::script_api
