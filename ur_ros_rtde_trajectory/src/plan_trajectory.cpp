// Plans a trajectory without a robot, as the backend of `./ur plan`: reads the fields of a goal as JSON from
// standard input and writes the plan as JSON to standard output. On failure, writes the reason to standard
// error and exits with 1.
//
//   {"model": "ur10e", "waypoints": [[rad, …], …]} with the fields of ExecuteTrajectory; or, with times,
//   {"points": [{"time": s, "positions": […], "velocities": […], "accelerations": […]}, …]}
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "ur_ros_rtde_trajectory/goal_ranges.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"
#include "ur_ros_rtde_trajectory/timed.hpp"

namespace {

using nlohmann::json;
using namespace ur_ros_rtde;
using trajectory::Joints;
using trajectory::Limits;

// As the driver says it.
Status check_range(const std::string & field, double value, double low, bool low_allowed, double high,
                   std::string_view unit = "")
{
  if (value <= high && (low_allowed ? value >= low : value > low)) {
    return {};
  }
  return failure(ErrorCode::invalid_goal,
                 fmt::format("{} is {:.10g}{}, it must be {} {:.4g} and at most {:.4g}{}", field, value, unit,
                             low_allowed ? "at least" : "above", low, high, unit));
}

struct GivenLimit {
  const char * field;
  const char * unit;
  Joints Limits::* limit;
  Joints highest;
};

Status read_limit(const json & goal, const GivenLimit & wanted, Limits & limits)
{
  if (!goal.contains(wanted.field)) {
    return {};
  }
  const auto given = trajectory::to_joints(wanted.field, goal.at(wanted.field).get<std::vector<double>>());
  if (!given) {
    return tl::unexpected(given.error());
  }
  for (int j = 0; j < trajectory::joint_count; ++j) {
    const auto name = fmt::format("{}[{}] ({})", wanted.field, j, trajectory::joint_name(j));
    if (Status fine = check_range(name, (*given)[j], 0.0, false, wanted.highest[j], wanted.unit); !fine) {
      return fine;
    }
  }
  limits.*wanted.limit = *given;
  return {};
}

Expected<Limits> read_limits(const json & goal)
{
  const std::string model = goal.value("model", "");
  const auto arm = model.empty() ? std::optional(widest_arm_limits()) : arm_limits(model);
  if (!arm) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("model is \"{}\": unknown model, give one of {}", model, arm_models()));
  }
  Limits limits = trajectory::make_limits(*arm);
  if (goal.contains("waypoints")) {
    limits =
        trajectory::default_speed_limits(limits);  // as execute_trajectory; given times determine the speed
  }
  const GivenLimit fields[] = {
      {"max_velocity", " rad/s", &Limits::velocity, trajectory::make_limits(*arm).velocity},
      {"max_acceleration", " rad/s^2", &Limits::acceleration,
       Joints::Constant(trajectory::max_goal_acceleration)},
      {"max_jerk", " rad/s^3", &Limits::jerk, Joints::Constant(trajectory::max_goal_jerk)},
  };
  for (const GivenLimit & field : fields) {
    if (Status read = read_limit(goal, field, limits); !read) {
      return tl::unexpected(read.error());
    }
  }
  return limits;
}

trajectory::TimedWaypoints read_points(const json & points)
{
  trajectory::TimedWaypoints waypoints;
  for (const json & point : points) {
    waypoints.times.push_back(point.at("time").get<double>());
    waypoints.positions.push_back(point.at("positions").get<std::vector<double>>());
    if (point.contains("velocities")) {
      waypoints.velocities.push_back(point["velocities"].get<std::vector<double>>());
    }
    if (point.contains("accelerations")) {
      waypoints.accelerations.push_back(point["accelerations"].get<std::vector<double>>());
    }
  }
  return waypoints;
}

Status check_fields(const json & goal)
{
  static const std::set<std::string> known{"model",          "waypoints",        "points",
                                           "max_velocity",   "max_acceleration", "max_jerk",
                                           "speed_fraction", "blend_tolerance",  "corner_angle"};
  for (const auto & [field, value] : goal.items()) {
    if (!known.contains(field)) {
      return failure(ErrorCode::invalid_goal,
                     fmt::format("unknown field {}; the fields are {}", field, fmt::join(known, ", ")));
    }
  }
  if (goal.contains("waypoints") == goal.contains("points")) {
    return failure(ErrorCode::invalid_goal, "give either waypoints, without times, or points, with times");
  }
  return {};
}

Expected<trajectory::Trajectory> plan(const json & goal, const Limits & limits)
{
  if (goal.contains("points")) {
    auto points = read_points(goal["points"]);
    trajectory::drop_close_waypoints(points);  // as the driver does
    return trajectory::plan_timed(points, limits);
  }
  trajectory::PathOptions options;
  options.blend_tolerance = goal.value("blend_tolerance", options.blend_tolerance);
  options.corner_angle = goal.value("corner_angle", options.corner_angle);
  options.speed_fraction = goal.value("speed_fraction", options.speed_fraction);
  if (Status fine = check_range("speed_fraction", options.speed_fraction, trajectory::min_goal_speed_fraction,
                                true, 1.0);
      !fine) {
    return tl::unexpected(fine.error());
  }
  if (Status fine = check_range("blend_tolerance", options.blend_tolerance, 0.0, true,
                                trajectory::max_goal_blend_tolerance, " rad");
      !fine) {
    return tl::unexpected(fine.error());
  }
  return trajectory::plan_path(goal["waypoints"].get<std::vector<std::vector<double>>>(), limits, options);
}

json to_json(const Joints & values)
{
  return std::vector<double>(values.begin(), values.end());
}

json to_json(const Limits & limits)
{
  return {{"position_min", to_json(limits.position_min)},
          {"position_max", to_json(limits.position_max)},
          {"velocity", to_json(limits.velocity)},
          {"acceleration", to_json(limits.acceleration)},
          {"jerk", to_json(limits.jerk)}};
}

json to_json(const trajectory::Trajectory & plan)
{
  constexpr int most_samples = 4000;
  const double duration = plan.duration();
  const int count = std::clamp(static_cast<int>(duration / 0.002), 1, most_samples);
  json samples;
  for (int k = 0; k <= count; ++k) {
    const double time = duration * k / count;
    const trajectory::Point point = plan.sample(time);
    samples["time"].push_back(time);
    samples["position"].push_back(to_json(point.position));
    samples["velocity"].push_back(to_json(point.velocity));
    samples["acceleration"].push_back(to_json(point.acceleration));
    samples["jerk"].push_back(to_json(point.jerk));
  }
  json waypoints = json::array();
  for (std::size_t i = 0; i < plan.waypoint_count(); ++i) {
    waypoints.push_back(plan.time_of_waypoint(i));
  }
  return {{"duration", duration}, {"waypoint_times", waypoints}, {"samples", samples}};
}

Expected<json> plan_to_json(const json & goal)
{
  if (Status known = check_fields(goal); !known) {
    return tl::unexpected(known.error());
  }
  const auto limits = read_limits(goal);
  if (!limits) {
    return tl::unexpected(limits.error());
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto planned = plan(goal, *limits);
  const std::chrono::duration<double> planning_time = std::chrono::steady_clock::now() - begin;
  if (!planned) {
    return tl::unexpected(planned.error());
  }
  const auto use = planned->verify(*limits);
  if (!use) {
    return tl::unexpected(use.error());
  }
  json result = to_json(*planned);
  result["planning_time"] = planning_time.count();
  result["limits"] = to_json(*limits);
  result["use"] = {{"velocity", use->velocity}, {"acceleration", use->acceleration}, {"jerk", use->jerk}};
  return result;
}

}  // namespace

int main()
{
  try {
    const auto result = plan_to_json(json::parse(std::cin));
    if (!result) {
      fmt::print(stderr, "{}\n", result.error().message);
      return 1;
    }
    std::cout << *result << '\n';
    return 0;
  } catch (const std::exception & error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
