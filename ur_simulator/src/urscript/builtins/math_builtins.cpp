#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "urscript/argument_reader.hpp"
#include "urscript/builtins/builtins.hpp"

namespace ur_simulator::urscript {

namespace {

using std::numbers::pi;

struct Unary {
  const char * name;
  double (*function)(double);
  double min = -HUGE_VAL;  ///< of the arguments allowed
  double max = HUGE_VAL;
  const char * parameter = "f";
};

constexpr Unary unary_functions[] = {
    {"acos", [](double f) { return std::acos(f); }, -1.0, 1.0},
    {"asin", [](double f) { return std::asin(f); }, -1.0, 1.0},
    {"atan", [](double f) { return std::atan(f); }},
    {"cos", [](double f) { return std::cos(f); }},
    {"d2r", [](double d) { return d * pi / 180.0; }, -HUGE_VAL, HUGE_VAL, "d"},
    {"r2d", [](double r) { return r * 180.0 / pi; }, -HUGE_VAL, HUGE_VAL, "r"},
    {"sin", [](double f) { return std::sin(f); }},
    {"sqrt", [](double f) { return std::sqrt(f); }, 0.0},
    {"tan", [](double f) { return std::tan(f); }},
};

void add_unary(Library & library, const Unary & unary)
{
  library.add({unary.name, {unary.parameter}, 1, [unary](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const double f = reader.number(0, unary.parameter);
                 reader.require(
                     f >= unary.min && f <= unary.max,
                     fmt::format("{} must be in [{}, {}], is {}", unary.parameter, unary.min, unary.max, f));
                 return reader ? Outcome(Value(unary.function(f))) : reader.failure();
               }});
}

struct Rounding {
  const char * name;
  double (*function)(double);
};

constexpr Rounding roundings[] = {
    {"ceil", [](double f) { return std::ceil(f); }},
    {"floor", [](double f) { return std::floor(f); }},
    {"round", [](double f) { return std::round(f); }},
};

void add_rounding(Library & library, const Rounding & rounding)
{
  library.add({rounding.name, {"f"}, 1, [rounding](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const double f = rounding.function(reader.number(0, "f"));
                 reader.require(std::abs(f) <= 2147483647.0, fmt::format("{} does not fit into an int", f));
                 return reader ? Outcome(Value(static_cast<std::int32_t>(f))) : reader.failure();
               }});
}

Outcome atan2(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double y = reader.number(0, "x");
  const double x = reader.number(1, "y");
  return reader ? Outcome(Value(std::atan2(y, x))) : reader.failure();
}

Outcome pow(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double result = std::pow(reader.number(0, "base"), reader.number(1, "exponent"));
  reader.require(std::isfinite(result), "the power is not a finite number");
  return reader ? Outcome(Value(result)) : reader.failure();
}

Outcome log(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double b = reader.number(0, "b");
  const double f = reader.number(1, "f");
  reader.require(b > 0.0 && b != 1.0 && f > 0.0,
                 fmt::format("base and f must be positive and base must not be 1; base = {}, f = {}", b, f));
  return reader ? Outcome(Value(std::log(f) / std::log(b))) : reader.failure();
}

Outcome norm(CallContext &, Arguments arguments)
{
  const Value & value = arguments[0];
  if (value.is(Type::pose)) {
    return Value(value.pose().norm());
  }
  if (value.is(Type::integer)) {
    const auto bits = static_cast<std::uint32_t>(value.integer());
    return Value(static_cast<std::int32_t>(value.integer() < 0 ? 0U - bits : bits));
  }
  if (value.is_number()) {
    return Value(std::abs(*value.number()));
  }
  if (!value.is(Type::list)) {
    return Failure{"the argument 'a' must be a list of numbers or a number"};
  }
  double sum = 0.0;
  for (const Value & element : value.list()) {
    if (!element.is_number()) {
      return Failure{"the argument 'a' must be a list of numbers or a number"};
    }
    sum += *element.number() * *element.number();
  }
  return Value(std::sqrt(sum));
}

}  // namespace

void add_math_builtins(Library & library)
{
  for (const Unary & unary : unary_functions) {
    add_unary(library, unary);
  }
  for (const Rounding & rounding : roundings) {
    add_rounding(library, rounding);
  }
  library.add({"atan2", {"x", "y"}, 2, atan2});
  library.add({"pow", {"base", "exponent"}, 2, pow});
  library.add({"log", {"b", "f"}, 2, log});
  library.add({"norm", {"a"}, 1, norm});
  // Default seed: the numbers are the same in every run.
  auto generator = std::make_shared<std::mt19937>();
  library.add({"random", {}, 0, [generator](CallContext &, Arguments) -> Outcome {
                 return Value(std::uniform_real_distribution<double>(0.0, 1.0)(*generator));
               }});
  library.simplify("random", "the same sequence after each start");
}

}  // namespace ur_simulator::urscript
