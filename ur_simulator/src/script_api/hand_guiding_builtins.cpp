#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

// Force mode, freedrive and contact detection belong here once the arm can do them. Until then they behave as
// on an arm that never entered these modes: what ends or tunes them is accepted, what starts them is in
// add_builtins_not_modelled().

namespace {

Outcome nothing_to_end(CallContext &, Arguments)
{
  return Value();
}

Outcome within(Arguments arguments, const char * name, double least, double most)
{
  ArgumentReader in(arguments);
  const double value = in.number(0, name);
  in.require(value >= least && value <= most,
             fmt::format("{} = {} is outside of [{}, {}]", name, value, least, most));
  return in ? Outcome(Value()) : in.failure();
}

}  // namespace

void add_hand_guiding_builtins(Library & library, const RobotPtr &)
{
  library.add({"end_force_mode", {}, 0, nothing_to_end});
  library.add({"end_freedrive_mode", {}, 0, nothing_to_end});
  library.add({"end_teach_mode", {}, 0, nothing_to_end});
  library.add({"force_mode_set_damping", {"damping"}, 1, [](CallContext &, Arguments arguments) {
                 return within(arguments, "damping", 0.0, 1.0);
               }});
  library.add({"force_mode_set_gain_scaling", {"scaling"}, 1, [](CallContext &, Arguments arguments) {
                 return within(arguments, "scaling", 0.0, 2.0);
               }});
  // 0: not in freedrive.
  library.add({"get_freedrive_status", {}, 0, [](CallContext &, Arguments) -> Outcome { return Value(0); }});
}

}  // namespace ur_simulator::script_api
