#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

/// A group of digital inputs and outputs and its first bit in Io.
struct DigitalGroup {
  const char * name;  ///< as in get_<name>_in()
  std::int32_t count;
  std::uint32_t first;
};

constexpr DigitalGroup groups[] = {
    {"standard_digital", 8, 0}, {"configurable_digital", 8, 8}, {"tool_digital", 2, 16}};

constexpr std::int32_t flag_count = 32;

std::uint32_t bit_number(ArgumentReader & reader, const DigitalGroup & group)
{
  const std::int32_t n = reader.integer(0, "n");
  reader.require(n >= 0 && n < group.count, fmt::format("n must be in [0, {1}], is {0}", n, group.count - 1));
  return reader ? group.first + static_cast<std::uint32_t>(n) : 0;
}

// get_digital_in() and the like number the two tool bits 8 and 9, after the eight standard ones.
std::uint32_t legacy_bit(ArgumentReader & reader)
{
  const std::int32_t n = reader.integer(0, "n");
  reader.require(n >= 0 && n < 10, fmt::format("n must be in [0, 9], is {}", n));
  return reader ? static_cast<std::uint32_t>(n < 8 ? n : n + 8) : 0;
}

using BitLocator = std::function<std::uint32_t(ArgumentReader &)>;

void add_digital_group(Library & library, const RobotContextPtr & robot, const std::string & name,
                       const BitLocator & locate_bit)
{
  const auto get = [robot, locate_bit](std::uint64_t Io::* bits) {
    return [robot, locate_bit, bits](CallContext &, Arguments arguments) -> Outcome {
      ArgumentReader reader(arguments);
      const std::uint32_t bit = locate_bit(reader);
      return reader ? Outcome(Value(((robot->state().io.*bits >> bit) & 1U) != 0)) : reader.failure();
    };
  };
  library.add({"get_" + name + "_in", {"n"}, 1, get(&Io::digital_inputs)});
  library.add({"get_" + name + "_out", {"n"}, 1, get(&Io::digital_outputs)});
  library.add({"set_" + name + "_out",
               {"n", "b"},
               2,
               [robot, locate_bit](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const std::uint64_t mask = std::uint64_t{1} << locate_bit(reader);
                 const bool on = reader.boolean(1, "b");
                 if (!reader) {
                   return reader.failure();
                 }
                 std::uint64_t & outputs = robot->state().io.digital_outputs;
                 outputs = on ? outputs | mask : outputs & ~mask;
                 return Value();
               }});
}

// Flags keep their values from one program to the next.
void add_flags(Library & library)
{
  auto flags = std::make_shared<std::uint32_t>(0);
  const auto flag = [](ArgumentReader & reader) { return bit_number(reader, {"flag", flag_count, 0}); };
  library.add({"get_flag", {"n"}, 1, [flags, flag](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const std::uint32_t bit = flag(reader);
                 return reader ? Outcome(Value(((*flags >> bit) & 1U) != 0)) : reader.failure();
               }});
  library.add({"set_flag", {"n", "b"}, 2, [flags, flag](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const std::uint32_t mask = 1U << flag(reader);
                 const bool on = reader.boolean(1, "b");
                 if (!reader) {
                   return reader.failure();
                 }
                 *flags = on ? *flags | mask : *flags & ~mask;
                 return Value();
               }});
}

}  // namespace

void add_digital_io_builtins(Library & library, const RobotContextPtr & robot)
{
  for (const DigitalGroup & group : groups) {
    add_digital_group(library, robot, group.name,
                      [group](ArgumentReader & reader) { return bit_number(reader, group); });
  }
  add_digital_group(library, robot, "digital", legacy_bit);
  library.add_indexed_name("digital_in", "get_digital_in");
  library.add_indexed_name("digital_out", "get_digital_out", "set_digital_out");
  add_flags(library);
}

}  // namespace ur_simulator::script_api
