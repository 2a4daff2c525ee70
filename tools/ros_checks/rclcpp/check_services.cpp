#include <gmock/gmock.h>

#include <std_srvs/srv/set_bool.hpp>
#include <ur_ros_rtde_msgs/srv/get_joint_state.hpp>
#include <ur_ros_rtde_msgs/srv/get_tcp_pose.hpp>

#include "client_test.hpp"

using std_srvs::srv::SetBool;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;
using ur_ros_rtde_msgs::srv::GetJointState;
using ur_ros_rtde_msgs::srv::GetTcpPose;

namespace {

class ServiceCheck : public ClientTest {
 protected:
  Arm arm{*node};

  template <typename Service>
  typename Service::Response::SharedPtr call(
      const std::string & name, const typename Service::Request & request = typename Service::Request())
  {
    const auto client = node->create_client<Service>(name);
    if (!client->wait_for_service(reply_limit)) {
      throw std::runtime_error("no service " + name);
    }
    return value_of(client->async_send_request(std::make_shared<typename Service::Request>(request)));
  }
};

TEST_F(ServiceCheck, JointStateIsThatOfTheTopic)
{
  ASSERT_TRUE(eventually([&] { return arm.at_rest(); }));
  const auto response = call<GetJointState>("get_joint_state");
  ASSERT_TRUE(response->success) << response->message;
  EXPECT_THAT(response->joint_state.name,
              ElementsAre("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint",
                          "wrist_2_joint", "wrist_3_joint"));
  EXPECT_THAT(response->joint_state.position, Pointwise(DoubleNear(0.001), arm.newest()->position));
}

TEST_F(ServiceCheck, TcpPoseIsAUnitQuaternion)
{
  const auto response = call<GetTcpPose>("get_tcp_pose");
  ASSERT_TRUE(response->success) << response->message;
  const auto & q = response->tcp_pose.pose.orientation;
  EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0, 1e-6);
}

TEST_F(ServiceCheck, FakeJointStatesAreSwitched)
{
  SetBool::Request request;
  request.data = true;
  EXPECT_TRUE(call<SetBool>("publish_fake_joint_states", request)->success);
  request.data = false;
  EXPECT_TRUE(call<SetBool>("publish_fake_joint_states", request)->success);
}

}  // namespace
