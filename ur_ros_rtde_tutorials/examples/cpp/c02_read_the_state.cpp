// c02: reads the state of the robot from the topic joint_states. Prints the joint positions ten times, once
// per second, in the order of the names in the message.
//
// ros2 run ur_ros_rtde_tutorials c02_read_the_state

#include <chrono>
#include <cstdio>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>

using sensor_msgs::msg::JointState;

constexpr int wanted_lines = 10;
constexpr int longest_wait = 20;  // s

class StateListener : public rclcpp::Node {
 public:
  StateListener() : Node("c02_read_the_state")
  {
    subscription_ = create_subscription<JointState>("joint_states", rclcpp::SensorDataQoS(),
                                                    [this](JointState::ConstSharedPtr message) {
                                                      ++samples_;
                                                      newest_ = message;
                                                    });
    timer_ = create_wall_timer(std::chrono::seconds(1), [this] { print(); });
  }

  int lines() const { return lines_; }

 private:
  /// Prints the newest state, if a message has been received since the last call.
  void print()
  {
    if (samples_ > 0) {
      std::printf("%4d samples", samples_);
      for (std::size_t i = 0; i < newest_->name.size(); ++i) {
        std::printf("  %s %.3f", newest_->name[i].c_str(), newest_->position.at(i));
      }
      std::printf("\n");
      std::fflush(stdout);
      samples_ = 0;
      ++lines_;
    }
    if (lines_ == wanted_lines || ++seconds_ == longest_wait) {
      rclcpp::shutdown();  // spin() returns
    }
  }

  rclcpp::Subscription<JointState>::SharedPtr subscription_;
  rclcpp::TimerBase::SharedPtr timer_;
  JointState::ConstSharedPtr newest_;
  int samples_ = 0;
  int lines_ = 0;
  int seconds_ = 0;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  const auto node = std::make_shared<StateListener>();
  rclcpp::spin(node);
  rclcpp::shutdown();
  if (node->lines() == 0) {
    std::fprintf(
        stderr,
        "no messages received: check that robot_state_receiver is running and connected to a robot\n");
  }
  return node->lines() == wanted_lines ? 0 : 1;
}
