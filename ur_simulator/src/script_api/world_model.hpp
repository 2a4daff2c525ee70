#pragma once

#include <map>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/pose.hpp"

namespace ur_simulator::script_api {

/// The coordinate frames of the script manual's world model: a tree with the frame "world", the frame "base",
/// which programs may move, the frames "flange" and "tcp" of the arm, and the frames that programs add.
/// Failures name the frame.
class WorldModel {
 public:
  using Result = tl::expected<void, std::string>;

  /// Updates the frames of the arm: poses in the base frame.
  void set_arm(const Transform & flange, const Transform & tcp);
  /// Adds a frame, attached to the world, at a pose in the frame `reference`.
  Result add(const std::string & name, const Transform & pose, const std::string & reference);
  /// Moves "base" or an added frame with the frames attached to it.
  Result move(const std::string & name, const Transform & pose, const std::string & reference);
  /// The child keeps its pose and moves with the parent from now on.
  Result attach(const std::string & child, const std::string & parent);
  /// Removes an added frame. The frames attached to it are attached to the world.
  Result erase(const std::string & name);
  /// Removes all added frames and moves the base to the origin of the world.
  void clear() { frames_ = initial_frames(); }

  bool contains(const std::string & name) const;
  tl::expected<std::string, std::string> parent(const std::string & name) const;
  std::vector<std::string> children(const std::string & name) const;
  /// Pose of the frame in the world.
  tl::expected<Transform, std::string> pose(const std::string & name) const;

 private:
  struct Frame {
    std::string parent;
    Transform pose;  ///< in the parent
  };

  static std::map<std::string, Frame> initial_frames();
  tl::expected<Frame *, std::string> movable(const std::string & name);
  tl::expected<Transform, std::string> placement(const std::string & parent, const Transform & pose,
                                                 const std::string & reference) const;

  Transform flange_ = Transform::Identity();
  Transform tcp_ = Transform::Identity();
  std::map<std::string, Frame> frames_ = initial_frames();  ///< those that programs may move
};

}  // namespace ur_simulator::script_api
