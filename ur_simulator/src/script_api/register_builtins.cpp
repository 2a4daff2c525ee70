#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

/// Access to one kind of register; the bank is ControllerState::inputs or outputs.
struct Kind {
  const char * name;
  std::size_t count;
  Value (*read)(const Registers & bank, std::size_t address);
  void (*write)(Registers & bank, std::size_t address, ArgumentReader & in);
};

constexpr Kind kinds[] = {
    {"boolean", 128, [](const Registers & bank, std::size_t i) { return Value(bank.bits[i]); },
     [](Registers & bank, std::size_t i, ArgumentReader & in) {
       const bool value = in.boolean(1, "value");
       if (in) {
         bank.bits[i] = value;
       }
     }},
    {"integer", 48, [](const Registers & bank, std::size_t i) { return Value(bank.integers[i]); },
     [](Registers & bank, std::size_t i, ArgumentReader & in) {
       const std::int32_t value = in.integer(1, "value");
       if (in) {
         bank.integers[i] = value;
       }
     }},
    {"float", 48, [](const Registers & bank, std::size_t i) { return Value(bank.doubles[i]); },
     [](Registers & bank, std::size_t i, ArgumentReader & in) {
       const double value = in.number(1, "value");
       if (in) {
         bank.doubles[i] = value;
       }
     }},
};

std::size_t address(ArgumentReader & in, std::size_t count)
{
  const std::int32_t address = in.integer(0, "address");
  in.require(address >= 0 && static_cast<std::size_t>(address) < count,
             fmt::format("address {} is outside of 0..{}", address, count - 1));
  return in ? static_cast<std::size_t>(address) : 0;
}

void add_read(Library & library, const RobotPtr & robot, const Kind & kind, const char * bank_name,
              Registers ControllerState::* bank)
{
  library.add({fmt::format("read_{}_{}_register", bank_name, kind.name),
               {"address"},
               1,
               [robot, kind, bank](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader in(arguments);
                 const std::size_t i = address(in, kind.count);
                 return in ? Outcome(kind.read(robot->state().*bank, i)) : in.failure();
               }});
}

}  // namespace

void add_register_builtins(Library & library, const RobotPtr & robot)
{
  for (const Kind & kind : kinds) {
    add_read(library, robot, kind, "input", &ControllerState::inputs);
    add_read(library, robot, kind, "output", &ControllerState::outputs);
    library.add({fmt::format("write_output_{}_register", kind.name),
                 {"address", "value"},
                 2,
                 [robot, kind](CallContext &, Arguments arguments) -> Outcome {
                   ArgumentReader in(arguments);
                   const std::size_t i = address(in, kind.count);
                   kind.write(robot->state().outputs, i, in);
                   return in ? Outcome(Value()) : in.failure();
                 }});
  }
}

}  // namespace ur_simulator::script_api
