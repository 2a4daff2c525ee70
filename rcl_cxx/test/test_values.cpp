#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "context/arguments.hpp"
#include "parameters/parameter_messages.hpp"
#include "parameters/parameter_rules.hpp"
#include "parameters/parameter_services.hpp"
#include "rcl_cxx/error.hpp"
#include "rcl_cxx/goal_uuid.hpp"
#include "rcl_cxx/parameter_value.hpp"
#include "rcl_cxx/qos.hpp"

using rcl_cxx::ParameterDescriptor;
using rcl_cxx::ParameterType;
using rcl_cxx::ParameterValue;
using rcl_cxx::QoS;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(QosTest, KnowsEveryNameItLists)
{
  for (const std::string & name : QoS::names()) {
    EXPECT_NO_THROW(QoS::from_name(name)) << name;
  }
  EXPECT_EQ(QoS::from_name("sensor_data"), QoS::sensor_data());
  EXPECT_EQ(QoS::from_name("latched"), QoS::from_name("transient_local"));
  EXPECT_EQ(QoS::from_name("default"), QoS::reliable(10));
}

TEST(QosTest, ListsKnownNamesWhenNameIsUnknown)
{
  try {
    QoS::from_name("sensordata");
    FAIL() << "no exception";
  } catch (const rcl_cxx::Error & error) {
    EXPECT_THAT(error.what(), HasSubstr("'sensordata'"));
    EXPECT_THAT(error.what(), HasSubstr("sensor_data, latched"));
  }
}

TEST(QosTest, KeepLastChangesTheDepthOnly)
{
  const QoS qos = QoS::sensor_data().keep_last(1);
  EXPECT_EQ(qos.get_rmw_qos_profile().depth, 1U);
  EXPECT_EQ(qos.get_rmw_qos_profile().reliability, RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT);
}

TEST(ParameterValueTest, HasTypeOfItsSource)
{
  EXPECT_EQ(ParameterValue().get_type(), ParameterType::not_set);
  EXPECT_EQ(ParameterValue(true).get_type(), ParameterType::boolean);
  EXPECT_EQ(ParameterValue(7).get_type(), ParameterType::integer);
  EXPECT_EQ(ParameterValue(7U).get_type(), ParameterType::integer);
  EXPECT_EQ(ParameterValue(7.0F).get_type(), ParameterType::floating_point);
  EXPECT_EQ(ParameterValue("text").get_type(), ParameterType::string);
  EXPECT_EQ(ParameterValue(std::vector<std::uint8_t>{1}).get_type(), ParameterType::byte_array);
  EXPECT_EQ(ParameterValue(std::vector<bool>{true}).get_type(), ParameterType::boolean_array);
  EXPECT_EQ(ParameterValue(std::vector<std::int64_t>{1}).get_type(), ParameterType::integer_array);
  EXPECT_EQ(ParameterValue(std::vector<double>{1.0}).get_type(), ParameterType::floating_point_array);
  EXPECT_EQ(ParameterValue(std::vector<std::string>{"a"}).get_type(), ParameterType::string_array);
}

TEST(ParameterValueTest, CannotBeReadAsAnotherType)
{
  try {
    ParameterValue(3).get<std::string>();
    FAIL() << "no exception";
  } catch (const rcl_cxx::Error & error) {
    EXPECT_STREQ(error.what(), "the value 3 is of type integer, not string");
  }
  EXPECT_THROW(ParameterValue(3).get<double>(), rcl_cxx::Error);
}

TEST(ParameterValueTest, RejectsIntegersThatDoNotFit)
{
  EXPECT_EQ(ParameterValue(255).get<std::uint8_t>(), 255);
  EXPECT_THROW(ParameterValue(256).get<std::uint8_t>(), rcl_cxx::Error);
  EXPECT_THROW(ParameterValue(-1).get<unsigned>(), rcl_cxx::Error);
  EXPECT_THROW(ParameterValue{std::numeric_limits<std::uint64_t>::max()}, rcl_cxx::Error);
}

TEST(ParameterValueTest, IsFormatted)
{
  EXPECT_EQ(ParameterValue().to_string(), "not set");
  EXPECT_EQ(ParameterValue(2.0).to_string(), "2.0");
  EXPECT_EQ(ParameterValue("a b").to_string(), "'a b'");
  EXPECT_EQ(ParameterValue(std::vector<bool>{true, false}).to_string(), "[true, false]");
  EXPECT_EQ(ParameterValue(std::vector<std::uint8_t>{1, 255}).to_string(), "[0x01, 0xff]");
}

TEST(ParameterValueTest, SurvivesConversionToMessage)
{
  const std::vector<ParameterValue> values = {{},
                                              true,
                                              -5,
                                              1.5,
                                              "text",
                                              std::vector<std::uint8_t>{0, 255},
                                              std::vector<bool>{true, false},
                                              std::vector<std::int64_t>{1, -1},
                                              std::vector<double>{0.5},
                                              std::vector<std::string>{"", "b"}};
  for (const ParameterValue & value : values) {
    EXPECT_EQ(rcl_cxx::detail::from_message(rcl_cxx::detail::to_message(value)), value) << value.to_string();
  }
}

TEST(ParameterValueTest, OfUnknownTypeIsNotSet)
{
  rcl_interfaces::msg::ParameterValue message;
  message.type = 77;
  EXPECT_EQ(rcl_cxx::detail::from_message(message), ParameterValue());
}

namespace {
rcl_cxx::SetParametersResult check(const ParameterDescriptor & options, const ParameterValue & value)
{
  const ParameterType type =
      options.floating_point_range ? ParameterType::floating_point : ParameterType::integer;
  return rcl_cxx::detail::check_value({"p", value}, type, options);
}
}  // namespace

TEST(ParameterRangeTest, IncludesItsLimits)
{
  const ParameterDescriptor options{.floating_point_range = rcl_cxx::FloatingPointRange{0.0, 1.5}};
  EXPECT_TRUE(check(options, 0.0));
  EXPECT_TRUE(check(options, 1.5));
  EXPECT_FALSE(check(options, -0.01));
  EXPECT_EQ(check(options, 1.6).error(), "parameter 'p' is limited to the range 0 to 1.5, it cannot be 1.6");
}

TEST(ParameterRangeTest, RejectsNanAndInfinity)
{
  const ParameterDescriptor options{.floating_point_range = rcl_cxx::FloatingPointRange{0.0, 1.0}};
  EXPECT_FALSE(check(options, std::nan("")));
  EXPECT_FALSE(check(options, std::numeric_limits<double>::infinity()));
}

TEST(ParameterRangeTest, WithStepAllowsMultiplesAndTheEnd)
{
  const ParameterDescriptor options{.floating_point_range = rcl_cxx::FloatingPointRange{0.1, 1.0, 0.2}};
  EXPECT_TRUE(check(options, 0.1 + 0.2 + 0.2));
  EXPECT_TRUE(check(options, 1.0));
  EXPECT_FALSE(check(options, 0.2));
  const ParameterDescriptor integers{.integer_range = rcl_cxx::IntegerRange{-5, 6, 2}};
  EXPECT_TRUE(check(integers, -3));
  EXPECT_TRUE(check(integers, 6));
  EXPECT_FALSE(check(integers, -4));
}

TEST(ParameterRangeTest, OfAllIntegersDoesNotOverflow)
{
  const ParameterDescriptor options{.integer_range = rcl_cxx::IntegerRange{INT64_MIN, INT64_MAX, 2}};
  EXPECT_TRUE(check(options, std::int64_t{INT64_MAX - 1}));
  EXPECT_TRUE(check(options, std::int64_t{INT64_MAX}));
  EXPECT_FALSE(check(options, std::int64_t{INT64_MAX - 2}));
}

TEST(ParameterRangeTest, AppliesToEachElementOfAnArray)
{
  const ParameterDescriptor options{.floating_point_range = rcl_cxx::FloatingPointRange{0.0, 1.0}};
  const auto check_array = [&](std::vector<double> values) {
    return rcl_cxx::detail::check_value({"p", values}, ParameterType::floating_point_array, options)
        .has_value();
  };
  EXPECT_TRUE(check_array({0.0, 1.0}));
  EXPECT_FALSE(check_array({0.0, 1.1}));
}

TEST(ParameterTypeTest, IsFixed)
{
  EXPECT_EQ(check({}, "x").error(),
            "Wrong parameter type: parameter 'p' is of type integer, it cannot be 'x' (string)");
}

TEST(ListParametersTest, FollowsPrefixesAndDepth)
{
  const std::vector<rcl_cxx::Parameter> all = {{"a", 1}, {"b.c", 1}, {"b.d.e", 1}, {"bc.x", 1}};
  const auto names = [&](const std::vector<std::string> & prefixes, std::uint64_t depth) {
    return rcl_cxx::detail::list_parameters(all, prefixes, depth).names;
  };
  EXPECT_THAT(names({}, 0), ElementsAre("a", "b.c", "b.d.e", "bc.x"));
  EXPECT_THAT(names({}, 1), ElementsAre("a"));
  EXPECT_THAT(names({}, 2), ElementsAre("a", "b.c", "bc.x"));
  EXPECT_THAT(names({"b"}, 0), ElementsAre("b.c", "b.d.e"));
  EXPECT_THAT(names({"b"}, 1), ElementsAre("b.c"));
  EXPECT_THAT(names({"a", "b.d"}, 0), ElementsAre("a", "b.d.e"));
  EXPECT_THAT(names({"none"}, 0), IsEmpty());
  EXPECT_THAT(rcl_cxx::detail::list_parameters(all, {}, 0).prefixes, UnorderedElementsAre("b", "b.d", "bc"));
}

TEST(ParameterFileTest, NodeNameMayHaveWildcards)
{
  using rcl_cxx::detail::matches_node;
  EXPECT_TRUE(matches_node("/robot/driver", "/robot/driver"));
  EXPECT_TRUE(matches_node("driver", "/driver"));
  EXPECT_FALSE(matches_node("driver", "/robot/driver"));
  EXPECT_TRUE(matches_node("/**", "/robot/left/driver"));
  EXPECT_TRUE(matches_node("/**/driver", "/driver"));
  EXPECT_TRUE(matches_node("/**/driver", "/robot/left/driver"));
  EXPECT_FALSE(matches_node("/**/driver", "/robot/left/other"));
  EXPECT_TRUE(matches_node("/*/driver", "/robot/driver"));
  EXPECT_FALSE(matches_node("/*/driver", "/robot/left/driver"));
  EXPECT_FALSE(matches_node("/*", "/robot/driver"));
  EXPECT_TRUE(matches_node("/**/left/**", "/robot/left/driver"));
  EXPECT_FALSE(matches_node("/robot", "/robot/driver"));
}

TEST(GoalUuidTest, IsRandomVersion4Uuid)
{
  std::set<rcl_cxx::GoalUUID> ids;
  for (int i = 0; i < 100; ++i) {
    const auto id = rcl_cxx::GoalUUID::random();
    ids.insert(id);
    const std::string text = id.to_string();
    ASSERT_EQ(text.size(), 36U);
    EXPECT_EQ(text[14], '4');
    EXPECT_THAT(std::string("89ab"), HasSubstr(text.substr(19, 1)));
  }
  EXPECT_EQ(ids.size(), 100U);
}

TEST(GoalUuidTest, IsFormatted)
{
  rcl_cxx::GoalUUID id;
  for (std::uint8_t i = 0; i < 16; ++i) {
    id.bytes[i] = i;
  }
  EXPECT_EQ(id.to_string(), "00010203-0405-0607-0809-0a0b0c0d0e0f");
  EXPECT_EQ(id.short_string(), "00010203");
}
