#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "urscript/argument_reader.hpp"
#include "urscript/builtins.hpp"

namespace ur_simulator::urscript {

namespace {

using std::numbers::pi;

struct Unary {
  const char * name;
  double (*function)(double);
  double least = -HUGE_VAL;  ///< of the arguments allowed
  double most = HUGE_VAL;
};

constexpr Unary unary_functions[] = {
    {"acos", [](double f) { return std::acos(f); }, -1.0, 1.0},
    {"asin", [](double f) { return std::asin(f); }, -1.0, 1.0},
    {"atan", [](double f) { return std::atan(f); }},
    {"cos", [](double f) { return std::cos(f); }},
    {"d2r", [](double f) { return f * pi / 180.0; }},
    {"r2d", [](double f) { return f * 180.0 / pi; }},
    {"sin", [](double f) { return std::sin(f); }},
    {"sqrt", [](double f) { return std::sqrt(f); }, 0.0},
    {"tan", [](double f) { return std::tan(f); }},
};

void add_unary(Library & library, const Unary & unary)
{
  library.add({unary.name, {"f"}, 1, [unary](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader in(arguments);
                 const double f = in.number(0, "f");
                 in.require(f >= unary.least && f <= unary.most,
                            fmt::format("f = {} is outside of [{}, {}]", f, unary.least, unary.most));
                 return in ? Outcome(Value(unary.function(f))) : in.failure();
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
                 ArgumentReader in(arguments);
                 const double f = rounding.function(in.number(0, "f"));
                 in.require(std::abs(f) <= 2147483647.0, fmt::format("{} does not fit an int", f));
                 return in ? Outcome(Value(static_cast<std::int32_t>(f))) : in.failure();
               }});
}

Outcome atan2(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const double y = in.number(0, "x");
  const double x = in.number(1, "y");
  return in ? Outcome(Value(std::atan2(y, x))) : in.failure();
}

Outcome pow(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const double result = std::pow(in.number(0, "base"), in.number(1, "exponent"));
  in.require(std::isfinite(result), "the power is not a finite number");
  return in ? Outcome(Value(result)) : in.failure();
}

Outcome log(CallContext &, Arguments arguments)
{
  ArgumentReader in(arguments);
  const double b = in.number(0, "b");
  const double f = in.number(1, "f");
  in.require(b > 0.0 && b != 1.0 && f > 0.0,
             fmt::format("base {} and f {} must be positive, and the base not 1", b, f));
  return in ? Outcome(Value(std::log(f) / std::log(b))) : in.failure();
}

Outcome norm(CallContext &, Arguments arguments)
{
  const Value & value = arguments[0];
  if (value.is(Type::pose)) {
    return Value(value.pose().norm());
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
  // The same numbers in every run: a simulation repeats.
  auto generator = std::make_shared<std::mt19937>();
  library.add({"random", {}, 0, [generator](CallContext &, Arguments) -> Outcome {
                 return Value(std::uniform_real_distribution<double>(0.0, 1.0)(*generator));
               }});
}

}  // namespace ur_simulator::urscript
