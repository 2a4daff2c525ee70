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

/// The functions of the URCap show a popup and halt the program (OnRobot's URCap 6.0.2).
Outcome halt(CallContext & context, std::string message)
{
  urscript::Popup popup;
  popup.title = "OnRobot - Soft Gripper error";
  popup.message = std::move(message);
  popup.error = true;
  context.host.show_popup(popup);
  return urscript::Halt{};
}

Outcome move_to(SoftGripper & gripper, CallContext & context, double width, bool gentle, bool blocking)
{
  if (width < SoftGripper::min_width || width > SoftGripper::max_width) {
    return halt(context, "The Soft Gripper Grip command returned with error.");
  }
  if (!gripper.is_powered()) {
    return halt(context, "Communication problem with a Soft Gripper. Please check the device.");
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

Outcome width(const SoftGripper & gripper, CallContext & context)
{
  return gripper.is_powered()
             ? Outcome(Value(gripper.width()))
             : halt(context, "Communication problem with a Soft Gripper. Please check the device.");
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
        "gentle_grip",
        {"tool_index", Value(0)},
        {"blocking", Value(true)},
        {"depth_compensation", Value(false)}},
       2,
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
  library.add({"get_sg_Width", {}, 0, [gripper](CallContext & context, Arguments) {
                 return width(*gripper, context);
               }});
  library.add({"get_sg_Busy", {}, 0, [gripper](CallContext &, Arguments) -> Outcome {
                 return Value(gripper->is_busy());
               }});
}

}  // namespace ur_simulator::script_api
