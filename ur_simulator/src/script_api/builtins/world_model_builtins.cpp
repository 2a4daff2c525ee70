#include "kinematics/forward_kinematics.hpp"
#include "script_api/robot_context.hpp"
#include "script_api/world_model.hpp"

namespace ur_simulator::script_api {

namespace {

Outcome to_outcome(const WorldModel::Result & result)
{
  return result ? Outcome(Value()) : Outcome(Failure{result.error()});
}

Outcome add_frame(WorldModel & model, ArgumentReader & reader)
{
  const std::string name = reader.string(0, "name");
  const Transform pose = to_transform(reader.pose(1, "pose"));
  const std::string reference = reader.string(2, "ref_name");
  return reader ? to_outcome(model.add(name, pose, reference)) : reader.failure();
}

Outcome move_frame(WorldModel & model, ArgumentReader & reader)
{
  const std::string name = reader.string(0, "name");
  const Transform pose = to_transform(reader.pose(1, "pose"));
  const std::string reference = reader.string(2, "ref_name");
  return reader ? to_outcome(model.move(name, pose, reference)) : reader.failure();
}

Outcome attach_frame(WorldModel & model, ArgumentReader & reader)
{
  const std::string child = reader.string(0, "child");
  const std::string parent = reader.string(1, "parent");
  return reader ? to_outcome(model.attach(child, parent)) : reader.failure();
}

Outcome delete_frame(WorldModel & model, ArgumentReader & reader)
{
  const std::string name = reader.string(0, "name");
  return reader ? to_outcome(model.erase(name)) : reader.failure();
}

Outcome clear_frames(WorldModel & model, ArgumentReader &)
{
  model.clear();
  return Value();
}

Outcome is_frame(WorldModel & model, ArgumentReader & reader)
{
  const std::string name = reader.string(0, "name");
  return reader ? Outcome(Value(model.contains(name))) : reader.failure();
}

Outcome frame_parent(WorldModel & model, ArgumentReader & reader)
{
  const std::string name = reader.string(0, "name");
  const auto parent = model.parent(name);
  reader.require(parent.has_value(), parent ? "" : parent.error());
  return reader ? Outcome(Value(*parent)) : reader.failure();
}

Outcome frame_children(WorldModel & model, ArgumentReader & reader)
{
  const std::string name = reader.string(0, "name");
  reader.require(model.contains(name), fmt::format("the world model has no frame '{}'", name));
  urscript::List names;
  for (const std::string & child : model.children(name)) {
    names.emplace_back(child);
  }
  return reader ? Outcome(Value(std::move(names))) : reader.failure();
}

Transform frame_pose(const WorldModel & model, ArgumentReader & reader, const std::string & name)
{
  const auto pose = model.pose(name);
  reader.require(pose.has_value(), pose ? "" : pose.error());
  return pose.value_or(Transform::Identity());
}

// The displacement from the frame `rel_name` to the frame `name`, in the axes of the frame `ref_name`.
Outcome relative_pose(WorldModel & model, ArgumentReader & reader)
{
  const Transform frame = frame_pose(model, reader, reader.string(0, "name"));
  const std::string relative_name = reader.string(1, "rel_name");
  const Transform relative = frame_pose(model, reader, relative_name);
  const Transform reference =
      frame_pose(model, reader, reader.given(2) ? reader.string(2, "ref_name") : relative_name);
  if (!reader) {
    return reader.failure();
  }
  const Transform difference = relative.inverse() * frame;
  const Eigen::Matrix3d axes = reference.linear().transpose() * relative.linear();
  Transform result = Transform::Identity();
  result.linear() = axes * difference.linear() * axes.transpose();
  result.translation() = axes * difference.translation();
  return Value::pose(to_pose(result));
}

Outcome convert_pose(WorldModel & model, ArgumentReader & reader)
{
  const Transform pose = to_transform(reader.pose(0, "pose"));
  const Transform from = frame_pose(model, reader, reader.string(1, "from_frame"));
  const Transform to = frame_pose(model, reader, reader.string(2, "to_frame"));
  return reader ? Outcome(Value::pose(to_pose(to.inverse() * from * pose))) : reader.failure();
}

}  // namespace

void add_world_model_builtins(Library & library, const RobotContextPtr & robot)
{
  const auto model = std::make_shared<WorldModel>();
  const auto add = [&](const char * name, std::vector<urscript::Parameter> parameters, std::size_t required,
                       Outcome (*function)(WorldModel & model, ArgumentReader & reader)) {
    library.add({name, std::move(parameters), required,
                 [model, robot, function](CallContext &, Arguments arguments) {
                   const ControllerState & state = robot->state();
                   model->set_arm(flange_pose(robot->access.model, state.actual.position),
                                  to_transform(state.actual_tcp_pose));
                   ArgumentReader reader(arguments);
                   return function(*model, reader);
                 },
                 false, 40});
  };
  const urscript::Parameter reference = urscript::Parameter("ref_name", Value("base")).formerly("refname");
  add("add_frame", {"name", "pose", reference}, 2, add_frame);
  add("move_frame", {"name", "pose", reference}, 2, move_frame);
  add("attach_frame", {"child", "parent"}, 2, attach_frame);
  add("delete_frame", {"name"}, 1, delete_frame);
  add("delete_all_frames", {}, 0, clear_frames);
  add("reset_world_model", {}, 0, clear_frames);
  add("is_frame", {"name"}, 1, is_frame);
  add("get_frame_parent", {"name"}, 1, frame_parent);
  add("get_children", {"name"}, 1, frame_children);
  add("get_pose", {"name", urscript::Parameter("rel_name", Value("base")), "ref_name"}, 1, relative_pose);
  add("convert_pose", {"pose", "from_frame", "to_frame"}, 3, convert_pose);
}

}  // namespace ur_simulator::script_api
