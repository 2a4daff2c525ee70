#include "script_api/robot_context.hpp"
#include "urscript/host.hpp"
#include "world/soft_gripper.hpp"
#include "world/world.hpp"

namespace ur_simulator::script_api {

namespace {

/// Waits until the gripper is no longer busy.
class GripperOperation final : public urscript::PendingCall {
 public:
  explicit GripperOperation(const SoftGripper & gripper) : gripper_(gripper) {}
  tl::expected<std::optional<Value>, std::string> poll(CallContext &) override
  {
    return gripper_.is_busy() ? std::optional<Value>() : Value(0);
  }

 private:
  const SoftGripper & gripper_;
};

constexpr int no_answer = -1;  // of the functions, from a gripper that the URCap does not reach

Outcome move_to(SoftGripper & gripper, CallContext & context, double width, bool gentle, bool blocking)
{
  if (width < SoftGripper::min_width || width > SoftGripper::max_width) {
    urscript::Popup popup;
    popup.title = "OnRobot";
    popup.message = fmt::format("Invalid parameter for Soft Gripper width {:g}, valid range is: {:g} - {:g}",
                                width, SoftGripper::min_width, SoftGripper::max_width);
    popup.warning = true;
    context.host.show_popup(popup);
    return NextCycle{Value(no_answer)};
  }
  if (!gripper.is_powered()) {
    return NextCycle{Value(no_answer)};
  }
  gripper.move_to(width, gentle);
  if (!blocking) {
    return NextCycle{Value(0)};
  }
  return std::make_unique<GripperOperation>(gripper);
}

/// There is one gripper, index 0.
void check_tool(ArgumentReader & reader, std::size_t index)
{
  const std::int32_t tool = reader.integer(index, "tool_index");
  reader.require(tool == 0, fmt::format("tool_index must be 0, is {}: there is one gripper", tool));
}

Outcome grip(SoftGripper & gripper, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double width = reader.number(0, "target_width");
  const bool gentle = reader.boolean(1, "gentle_grip");
  check_tool(reader, 2);
  const bool blocking = reader.boolean(3, "blocking");
  return reader ? move_to(gripper, context, width, gentle, blocking) : reader.failure();
}

Outcome release(SoftGripper & gripper, CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double width = reader.number(0, "target_width");
  check_tool(reader, 1);
  const bool blocking = reader.boolean(2, "blocking");
  return reader ? move_to(gripper, context, width, false, blocking) : reader.failure();
}

Outcome width(const SoftGripper & gripper, Arguments arguments)
{
  ArgumentReader reader(arguments);
  check_tool(reader, 0);
  const double reported = gripper.is_powered() ? gripper.width() : no_answer;
  return reader ? Outcome(Value(reported)) : reader.failure();
}

}  // namespace

void add_gripper_builtins(Library & library, const RobotContextPtr & robot)
{
  SoftGripper * gripper = robot->access.world.gripper();
  if (gripper == nullptr) {
    return;
  }
  library.add(
      {"sg_grip",
       {"target_width",
        {"gentle_grip", Value(false)},
        {"tool_index", Value(0)},
        {"blocking", Value(true)},
        {"depth_compensation", Value(false)}},
       1,
       [gripper](CallContext & context, Arguments arguments) { return grip(*gripper, context, arguments); }});
  library.add({"sg_release",
               {"target_width",
                {"tool_index", Value(0)},
                {"blocking", Value(true)},
                {"depth_compensation", Value(false)}},
               1,
               [gripper](CallContext & context, Arguments arguments) {
                 return release(*gripper, context, arguments);
               }});
  for (const char * name : {"get_sg_Width", "sg_get_width"}) {
    library.add({name, {{"tool_index", Value(0)}}, 0, [gripper](CallContext &, Arguments arguments) {
                   return width(*gripper, arguments);
                 }});
  }
  library.add({"sg_busy", {{"tool_index", Value(0)}}, 0, [gripper](CallContext &, Arguments) -> Outcome {
                 return Value(gripper->is_busy());
               }});
}

}  // namespace ur_simulator::script_api
