#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

/// A group of digital lines and where it begins in Io's bits.
struct Lines {
  const char * name;  ///< as in get_<name>_in
  std::int32_t count;
  std::uint32_t first;
};

constexpr Lines groups[] = {
    {"standard_digital", 8, 0}, {"configurable_digital", 8, 8}, {"tool_digital", 2, 16}};

constexpr std::int32_t flag_count = 32;

std::uint32_t line(ArgumentReader & in, const Lines & lines)
{
  const std::int32_t n = in.integer(0, "n");
  in.require(n >= 0 && n < lines.count, fmt::format("n = {} is outside of 0..{}", n, lines.count - 1));
  return in ? lines.first + static_cast<std::uint32_t>(n) : 0;
}

// The old names count the tool's two lines on after the eight standard ones.
std::uint32_t old_line(ArgumentReader & in)
{
  const std::int32_t n = in.integer(0, "n");
  in.require(n >= 0 && n < 10, fmt::format("n = {} is outside of 0..9", n));
  return in ? static_cast<std::uint32_t>(n < 8 ? n : n + 8) : 0;
}

using Locate = std::function<std::uint32_t(ArgumentReader &)>;

void add_lines(Library & library, const RobotPtr & robot, const std::string & name, const Locate & locate)
{
  const auto get = [robot, locate](std::uint64_t Io::* bits) {
    return [robot, locate, bits](CallContext &, Arguments arguments) -> Outcome {
      ArgumentReader in(arguments);
      const std::uint32_t bit = locate(in);
      return in ? Outcome(Value(((robot->state().io.*bits >> bit) & 1U) != 0)) : in.failure();
    };
  };
  library.add({"get_" + name + "_in", {"n"}, 1, get(&Io::digital_inputs)});
  library.add({"get_" + name + "_out", {"n"}, 1, get(&Io::digital_outputs)});
  library.add(
      {"set_" + name + "_out", {"n", "b"}, 2, [robot, locate](CallContext &, Arguments arguments) -> Outcome {
         ArgumentReader in(arguments);
         const std::uint64_t mask = std::uint64_t{1} << locate(in);
         const bool on = in.boolean(1, "b");
         if (!in) {
           return in.failure();
         }
         std::uint64_t & outputs = robot->state().io.digital_outputs;
         outputs = on ? outputs | mask : outputs & ~mask;
         return Value();
       }});
}

// Flags are the program's own memory, kept from program to program.
void add_flags(Library & library)
{
  auto flags = std::make_shared<std::uint32_t>(0);
  const auto flag = [](ArgumentReader & in) { return line(in, {"flag", flag_count, 0}); };
  library.add({"get_flag", {"n"}, 1, [flags, flag](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader in(arguments);
                 const std::uint32_t bit = flag(in);
                 return in ? Outcome(Value(((*flags >> bit) & 1U) != 0)) : in.failure();
               }});
  library.add({"set_flag", {"n", "b"}, 2, [flags, flag](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader in(arguments);
                 const std::uint32_t mask = 1U << flag(in);
                 const bool on = in.boolean(1, "b");
                 if (!in) {
                   return in.failure();
                 }
                 *flags = on ? *flags | mask : *flags & ~mask;
                 return Value();
               }});
}

}  // namespace

void add_digital_io_builtins(Library & library, const RobotPtr & robot)
{
  for (const Lines & lines : groups) {
    add_lines(library, robot, lines.name, [lines](ArgumentReader & in) { return line(in, lines); });
  }
  add_lines(library, robot, "digital", old_line);
  add_flags(library);
}

}  // namespace ur_simulator::script_api
