#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <rosidl_typesupport_cpp/action_type_support.hpp>
#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <rosidl_typesupport_cpp/service_type_support.hpp>
#include <std_msgs/msg/string.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <test_msgs/action/fibonacci.hpp>

#include "rcl_support/rcl_compat.hpp"
#include "rcl_support/type_support.hpp"

using rcl_cxx::detail::ActionTypeSupport;
using rcl_cxx::detail::MessageTypeSupport;
using rcl_cxx::detail::ServiceTypeSupport;

#if RCL_VERSION_MAJOR >= 6
namespace {
/// rcl copies the description and the sources of each type, and other nodes compare its hash.
template <typename TypeSupport>
void expect_hash_without_description(const TypeSupport * generated, const TypeSupport * given)
{
  ASSERT_NE(given, nullptr);
  EXPECT_EQ(std::memcmp(given->get_type_hash_func(given), generated->get_type_hash_func(generated),
                        sizeof(rosidl_type_hash_t)),
            0);
  EXPECT_GT(generated->get_type_description_func(generated)->type_description.fields.size, 0U);
  EXPECT_EQ(given->get_type_description_func(given)->type_description.fields.size, 0U);
  EXPECT_EQ(given->get_type_description_func(given)->referenced_type_descriptions.size, 0U);
  EXPECT_GT(generated->get_type_description_sources_func(generated)->size, 0U);
  EXPECT_EQ(given->get_type_description_sources_func(given)->size, 0U);
}
}  // namespace

TEST(TypeSupportTest, KeepsHashOfMessageWithoutDescription)
{
  const auto * const generated =
      rosidl_typesupport_cpp::get_message_type_support_handle<std_msgs::msg::String>();
  const MessageTypeSupport type_support(generated);
  expect_hash_without_description(generated, type_support.get());
}

// A participant of Fast DDS still refers to it when the type is registered again.
TEST(TypeSupportTest, IsKeptWhenTheEntityIsGone)
{
  const auto * const generated =
      rosidl_typesupport_cpp::get_message_type_support_handle<std_msgs::msg::String>();
  const auto * const first = MessageTypeSupport(generated).get();
  EXPECT_EQ(MessageTypeSupport(generated).get(), first);
  EXPECT_NE(first, generated);
}

TEST(TypeSupportTest, KeepsHashOfServiceWithoutDescription)
{
  const auto * const generated =
      rosidl_typesupport_cpp::get_service_type_support_handle<std_srvs::srv::SetBool>();
  const ServiceTypeSupport type_support(generated);
  expect_hash_without_description(generated, type_support.get());
}

TEST(TypeSupportTest, KeepsHashesOfActionWithoutDescriptions)
{
  const auto * const generated =
      rosidl_typesupport_cpp::get_action_type_support_handle<test_msgs::action::Fibonacci>();
  const ActionTypeSupport type_support(*generated);
  const auto * const given = type_support.get();
  expect_hash_without_description(generated, given);
  expect_hash_without_description(generated->goal_service_type_support, given->goal_service_type_support);
  expect_hash_without_description(generated->result_service_type_support, given->result_service_type_support);
  expect_hash_without_description(generated->cancel_service_type_support, given->cancel_service_type_support);
  expect_hash_without_description(generated->feedback_message_type_support,
                                  given->feedback_message_type_support);
  expect_hash_without_description(generated->status_message_type_support, given->status_message_type_support);
}
#endif

TEST(TypeSupportTest, PassesMissingTypeOn)
{
  EXPECT_EQ(MessageTypeSupport(nullptr).get(), nullptr);
}
