#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

/// Access to the registers of one type; the bank is ControllerState::inputs or outputs.
struct RegisterType {
  const char * name;
  std::size_t count;
  Value (*read)(const Registers & bank, std::size_t address);
  void (*write)(Registers & bank, std::size_t address, ArgumentReader & reader);
};

constexpr RegisterType register_types[] = {
    {"boolean", 128, [](const Registers & bank, std::size_t i) { return Value(bank.bits[i]); },
     [](Registers & bank, std::size_t i, ArgumentReader & reader) {
       const bool value = reader.boolean(1, "value");
       if (reader) {
         bank.bits[i] = value;
       }
     }},
    {"integer", 48, [](const Registers & bank, std::size_t i) { return Value(bank.integers[i]); },
     [](Registers & bank, std::size_t i, ArgumentReader & reader) {
       const std::int32_t value = reader.integer(1, "value");
       if (reader) {
         bank.integers[i] = value;
       }
     }},
    {"float", 48, [](const Registers & bank, std::size_t i) { return Value(double{bank.floats[i]}); },
     [](Registers & bank, std::size_t i, ArgumentReader & reader) {
       const double value = reader.number(1, "value");
       if (reader) {
         bank.floats[i] = static_cast<float>(value);
       }
     }},
};

std::size_t address(ArgumentReader & reader, std::size_t count)
{
  const std::int32_t address = reader.integer(0, "address");
  reader.require(address >= 0 && static_cast<std::size_t>(address) < count,
                 fmt::format("address must be in [0, {}], is {}", count - 1, address));
  return reader ? static_cast<std::size_t>(address) : 0;
}

void add_read(Library & library, const RobotContextPtr & robot, const RegisterType & type,
              const char * bank_name, Registers ControllerState::* bank)
{
  library.add({fmt::format("read_{}_{}_register", bank_name, type.name),
               {"address"},
               1,
               [robot, type, bank](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const std::size_t i = address(reader, type.count);
                 return reader ? Outcome(type.read(robot->state().*bank, i)) : reader.failure();
               }});
}

}  // namespace

void add_register_builtins(Library & library, const RobotContextPtr & robot)
{
  for (const RegisterType & type : register_types) {
    add_read(library, robot, type, "input", &ControllerState::inputs);
    add_read(library, robot, type, "output", &ControllerState::outputs);
    library.add({fmt::format("write_output_{}_register", type.name),
                 {"address", "value"},
                 2,
                 [robot, type](CallContext &, Arguments arguments) -> Outcome {
                   ArgumentReader reader(arguments);
                   const std::size_t i = address(reader, type.count);
                   type.write(robot->state().outputs, i, reader);
                   return reader ? Outcome(Value()) : reader.failure();
                 }});
  }
}

}  // namespace ur_simulator::script_api
