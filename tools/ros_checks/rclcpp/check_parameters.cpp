#include <gmock/gmock.h>

#include "client_test.hpp"

using rcl_interfaces::msg::ParameterType;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

namespace {

class ParameterCheck : public ClientTest {
 protected:
  void SetUp() override { ASSERT_TRUE(client->wait_for_service(reply_limit)); }
  rcl_interfaces::msg::SetParametersResult set(const rclcpp::Parameter & parameter)
  {
    return value_of(client->set_parameters({parameter})).at(0);
  }

  std::shared_ptr<rclcpp::AsyncParametersClient> client =
      std::make_shared<rclcpp::AsyncParametersClient>(node, "command_server");
};

TEST_F(ParameterCheck, AreListed)
{
  const auto listed = value_of(client->list_parameters({}, 10));
  for (const char * name : {"robot_ip", "ur_type", "watchdog_frequency", "use_sim_time"}) {
    EXPECT_THAT(listed.names, Contains(name));
  }
}

TEST_F(ParameterCheck, HaveTypedValues)
{
  const auto values =
      value_of(client->get_parameters({"ur_type", "watchdog_frequency", "urcap_port", "plugins"}));
  ASSERT_THAT(values, SizeIs(4));
  EXPECT_EQ(values[0].as_string(), "ur10e");
  EXPECT_GT(values[1].as_double(), 0.0);
  EXPECT_GT(values[2].as_int(), 0);
  EXPECT_TRUE(values[3].as_string_array().empty());
}

TEST_F(ParameterCheck, AreDescribed)
{
  const auto descriptors = value_of(client->describe_parameters({"watchdog_frequency"}));
  ASSERT_THAT(descriptors, SizeIs(1));
  EXPECT_EQ(descriptors[0].type, ParameterType::PARAMETER_DOUBLE);
  EXPECT_TRUE(descriptors[0].read_only);
  EXPECT_THAT(descriptors[0].description, HasSubstr("Hz"));
  ASSERT_THAT(descriptors[0].floating_point_range, SizeIs(1));
  EXPECT_EQ(descriptors[0].floating_point_range[0].to_value, 50.0);
}

TEST_F(ParameterCheck, ReadOnlyOneIsRejectedWithReason)
{
  const auto result = set({"watchdog_frequency", 5.0});
  EXPECT_FALSE(result.successful);
  EXPECT_THAT(result.reason, HasSubstr("'watchdog_frequency' cannot be set because it is read-only"));
  const auto atomically =
      value_of(client->set_parameters_atomically({rclcpp::Parameter("robot_ip", "10.0.0.1")}));
  EXPECT_FALSE(atomically.successful);
  EXPECT_THAT(atomically.reason, HasSubstr("read-only"));
}

TEST_F(ParameterCheck, UnknownOneIsRejectedWithReason)
{
  const auto result = set({"speed_of_light", 3e8});
  EXPECT_FALSE(result.successful);
  EXPECT_THAT(result.reason, HasSubstr("speed_of_light"));
}

TEST_F(ParameterCheck, WrongTypeIsRejectedWithReason)
{
  const auto result = set({"use_sim_time", 1.5});
  EXPECT_FALSE(result.successful);
  EXPECT_THAT(result.reason, HasSubstr("type"));
}

TEST_F(ParameterCheck, ChangeIsAnnounced)
{
  std::promise<std::string> changed;
  auto handler = rclcpp::ParameterEventHandler(node);
  const auto handle = handler.add_parameter_callback(
      "use_sim_time", [&](const rclcpp::Parameter & parameter) { changed.set_value(parameter.get_name()); },
      "/command_server");
  ASSERT_TRUE(eventually([&] { return node->count_publishers("/parameter_events") > 1; }));
  EXPECT_TRUE(set({"use_sim_time", false}).successful);
  EXPECT_EQ(value_of(changed.get_future()), "use_sim_time");
}

}  // namespace
