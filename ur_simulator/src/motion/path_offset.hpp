#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// path_offset_…(): an offset of the TCP that is superposed on the motion of the program (script manual,
/// "path_offset_set").
class PathOffset {
 public:
  /// In which axes an offset is given.
  enum class Frame {
    base = 1,
    tcp = 2,
    motion = 3,  ///< x along the path, y along x × z of the tool, z along x × y
    world = 4,   ///< the offset is the pose of the base in the world, in which the path is understood
  };

  /// Starts without an offset. Filter and limits are kept.
  void enable();
  void disable() { enabled_ = false; }
  bool enabled() const { return enabled_; }
  /// The offset to apply, m and rotation vector; components beyond the limits are cut.
  void set(const Vector6 & offset, Frame frame);
  /// First order filter of the offset: the share of the new value in each cycle, 1: no filter.
  void set_filter(double alpha) { alpha_ = alpha; }
  /// Limits of each component, m and rad.
  void set_limits(double translation, double rotation);
  /// The offset that is applied currently, in these axes.
  Vector6 get(Frame frame) const;
  /// Drops the offset, because the arm stops where it is.
  void restart();

  /// The pose of the TCP in the next cycle. `path_tcp` is its pose on the path of the program,
  /// `path_velocity` its velocity there.
  Transform apply(const Transform & path_tcp, const Vector3 & path_velocity);

 private:
  void update_motion_axes(const Transform & path_tcp, const Vector3 & path_velocity);
  Transform offset_pose() const;

  bool enabled_ = false;
  Frame frame_ = Frame::base;
  Vector6 requested_ = Vector6::Zero();
  Vector6 applied_ = Vector6::Zero();
  double alpha_ = 1.0;
  double max_translation_ = 0.1;                           ///< m
  double max_rotation_ = 0.52;                             ///< rad
  Eigen::Matrix3d motion_axes_ = Eigen::Matrix3d::Zero();  ///< zero until the path has moved
  Transform path_tcp_ = Transform::Identity();
  Transform tcp_ = Transform::Identity();
};

}  // namespace ur_simulator
