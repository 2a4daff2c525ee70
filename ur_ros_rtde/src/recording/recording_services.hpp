#pragma once

#include <rcl_cxx/node.hpp>
#include <string>
#include <ur_ros_rtde_msgs/srv/start_recording.hpp>
#include <ur_ros_rtde_msgs/srv/stop_recording.hpp>

#include "recording/recorder.hpp"

namespace ur_ros_rtde {

/// The services start_recording and stop_recording. The destructor ends an active recording.
class RecordingServices {
 public:
  /// `address`: of the robot. `log`: for messages about a running recording.
  RecordingServices(rcl_cxx::Node & node, const std::string & address, LogFunction log);

 private:
  using Start = ur_ros_rtde_msgs::srv::StartRecording;
  using Stop = ur_ros_rtde_msgs::srv::StopRecording;

  void start(const Start::Request & request, Start::Response & response);
  void stop(Stop::Response & response);

  rcl_cxx::Node & node_;
  Recorder recorder_;
  rcl_cxx::Service<Start>::SharedPtr start_recording_;
  rcl_cxx::Service<Stop>::SharedPtr stop_recording_;
};

}  // namespace ur_ros_rtde
