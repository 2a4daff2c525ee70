#include "script_api/world_model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ur_simulator::script_api {

namespace {

constexpr std::size_t frame_limit = 100;
constexpr const char * world = "world";
constexpr const char * base_frame = "base";

struct FixedFrame {
  const char * name;
  const char * parent;
};

// Frames that programs can neither add nor move. The world has no parent.
constexpr FixedFrame fixed_frames[] = {{world, ""}, {"flange", base_frame}, {"tcp", "flange"}};

const FixedFrame * find_fixed(const std::string & name)
{
  const auto * found = std::find_if(std::begin(fixed_frames), std::end(fixed_frames),
                                    [&](const FixedFrame & frame) { return name == frame.name; });
  return found == std::end(fixed_frames) ? nullptr : found;
}

tl::unexpected<std::string> no_frame(const std::string & name)
{
  return tl::unexpected(fmt::format("the world model has no frame '{}'", name));
}

}  // namespace

std::map<std::string, WorldModel::Frame> WorldModel::initial_frames()
{
  return {{base_frame, {world, Transform::Identity()}}};
}

void WorldModel::set_arm(const Transform & flange, const Transform & tcp)
{
  flange_ = flange;
  tcp_ = tcp;
}

bool WorldModel::contains(const std::string & name) const
{
  return find_fixed(name) != nullptr || frames_.contains(name);
}

tl::expected<Transform, std::string> WorldModel::pose(const std::string & name) const
{
  Transform total = Transform::Identity();
  std::string at = name;
  while (at != world) {
    const auto frame = frames_.find(at);
    if (frame != frames_.end()) {
      total = frame->second.pose * total;
      at = frame->second.parent;
    } else if (find_fixed(at) != nullptr) {
      total = (at == "tcp" ? tcp_ : flange_) * total;
      at = base_frame;
    } else {
      return no_frame(name);
    }
  }
  return total;
}

tl::expected<std::string, std::string> WorldModel::parent(const std::string & name) const
{
  if (const FixedFrame * frame = find_fixed(name)) {
    return std::string(frame->parent);
  }
  const auto found = frames_.find(name);
  if (found == frames_.end()) {
    return no_frame(name);
  }
  return found->second.parent;
}

std::vector<std::string> WorldModel::children(const std::string & name) const
{
  std::vector<std::string> result;
  for (const FixedFrame & frame : fixed_frames) {
    if (name == frame.parent) {
      result.emplace_back(frame.name);
    }
  }
  for (const auto & [child, frame] : frames_) {
    if (frame.parent == name) {
      result.push_back(child);
    }
  }
  return result;
}

tl::expected<Transform, std::string> WorldModel::placement(const std::string & parent_name,
                                                           const Transform & pose_in_reference,
                                                           const std::string & reference) const
{
  const auto origin = pose(reference);
  const auto base = pose(parent_name);
  if (!origin) {
    return tl::unexpected(origin.error());
  }
  if (!base) {
    return tl::unexpected(base.error());
  }
  return Transform(base->inverse() * *origin * pose_in_reference);
}

WorldModel::Result WorldModel::add(const std::string & name, const Transform & pose_in_reference,
                                   const std::string & reference)
{
  if (name.empty() || contains(name)) {
    return tl::unexpected(
        fmt::format("the world model has a frame '{}' already, or the name is empty", name));
  }
  if (frames_.size() > frame_limit) {
    return tl::unexpected(fmt::format("the world model has {} frames already", frame_limit));
  }
  const auto place = placement(world, pose_in_reference, reference);
  if (!place) {
    return tl::unexpected(place.error());
  }
  frames_[name] = {world, *place};
  return {};
}

tl::expected<WorldModel::Frame *, std::string> WorldModel::movable(const std::string & name)
{
  const auto found = frames_.find(name);
  if (found != frames_.end()) {
    return &found->second;
  }
  return find_fixed(name) == nullptr ? no_frame(name)
                                     : tl::unexpected(fmt::format("the frame '{}' is fixed", name));
}

WorldModel::Result WorldModel::move(const std::string & name, const Transform & pose_in_reference,
                                    const std::string & reference)
{
  const auto frame = movable(name);
  if (!frame) {
    return tl::unexpected(frame.error());
  }
  const auto place = placement((*frame)->parent, pose_in_reference, reference);
  if (!place) {
    return tl::unexpected(place.error());
  }
  (*frame)->pose = *place;
  return {};
}

WorldModel::Result WorldModel::attach(const std::string & child, const std::string & parent_name)
{
  const auto frame = movable(child);
  if (!frame) {
    return tl::unexpected(frame.error());
  }
  for (auto above = tl::expected<std::string, std::string>(parent_name); above && *above != world;
       above = parent(*above)) {
    if (*above == child) {
      return tl::unexpected(fmt::format("the frame '{}' is attached to '{}' already", parent_name, child));
    }
  }
  const auto place = placement(parent_name, Transform::Identity(), child);
  if (!place) {
    return tl::unexpected(place.error());
  }
  **frame = {parent_name, *place};
  return {};
}

WorldModel::Result WorldModel::erase(const std::string & name)
{
  if (name == base_frame) {
    return tl::unexpected(fmt::format("the frame '{}' cannot be deleted", name));
  }
  const auto frame = movable(name);
  if (!frame) {
    return tl::unexpected(frame.error());
  }
  for (const std::string & child : children(name)) {
    attach(child, world);
  }
  frames_.erase(name);
  return {};
}

}  // namespace ur_simulator::script_api
