#include "robot_fixture.hpp"
#include "state/arm_model.hpp"

namespace ur_ros_rtde::test {
namespace {

TEST(ArmModelsTest, AreIdentifiedByTypeNumber)
{
  EXPECT_EQ(model_of_type(1, true), "ur5");
  EXPECT_EQ(model_of_type(1, false), "ur5e");
  EXPECT_EQ(model_of_type(2, false), "ur10e");
  EXPECT_EQ(model_of_type(9, false), "ur15");
  EXPECT_FALSE(model_of_type(4, true)) << "there is no UR16 of the CB3 series";
  EXPECT_FALSE(model_of_type(77, false));
}

TEST(ArmLimitsTest, AreFoundInAnySpelling)
{
  EXPECT_TRUE(arm_limits("UR8 Long"));
  EXPECT_TRUE(arm_limits("UR10e"));
  EXPECT_FALSE(arm_limits("ur99"));
  EXPECT_NE(arm_models().find("ur8long, ur15"), std::string::npos);
}

TEST(ArmLimitsTest, CommonLimitsAreWithinThoseOfEachModel)
{
  const auto common = common_arm_limits();
  for (const char * model : {"ur3", "ur5e", "ur10", "ur20", "ur30", "ur15"}) {
    for (std::size_t joint = 0; joint < 6; ++joint) {
      EXPECT_LE(common.velocity[joint], arm_limits(model)->velocity[joint]) << model;
      EXPECT_GT(common.velocity[joint], 2.0);
    }
  }
}

struct ModelCase {
  const char * simulated;
  const char * polyscope;
  const char * detected;
};

struct DetectedModelTest : RobotFixture, testing::WithParamInterface<ModelCase> {};

TEST_P(DetectedModelTest, IsIdentifiedFromTheControllersData)
{
  auto simulator = Controller::options();
  simulator.model = GetParam().simulated;
  simulator.polyscope_version = GetParam().polyscope;
  controller.start(simulator);
  make_robot();
  ASSERT_TRUE(becomes_ready());
  const auto expected = arm_limits(GetParam().simulated);
  EXPECT_EQ(robot->limits().velocity, expected->velocity);
  EXPECT_EQ(robot->limits().reach, expected->reach);
  EXPECT_EQ(log.count("is a " + std::string(GetParam().detected)), 1U) << log.text();
}

INSTANTIATE_TEST_SUITE_P(
    OfModels, DetectedModelTest,
    testing::Values(ModelCase{"ur3", "3.5.0", "ur3"}, ModelCase{"ur5", "3.12.0", "ur5"},
                    ModelCase{"ur10", "3.15.8", "ur10"}, ModelCase{"ur3e", "5.6.0", "ur3e"},
                    ModelCase{"ur5e", "5.13.0", "ur5e"}, ModelCase{"ur7e", "5.25.1", "ur5e (or ur7e)"},
                    ModelCase{"ur12e", "5.25.1", "ur10e (or ur12e)"}, ModelCase{"ur16e", "5.13.0", "ur16e"},
                    ModelCase{"ur8long", "5.25.1", "ur8long"}, ModelCase{"ur15", "5.25.1", "ur15"},
                    ModelCase{"ur18", "5.25.1", "ur18"}, ModelCase{"ur20", "5.25.1", "ur20"},
                    ModelCase{"ur30", "5.25.1", "ur30"}),
    [](const auto & one) { return std::string(one.param.simulated); });

struct CalibratedArmTest : RobotFixture {};

TEST_F(CalibratedArmTest, HasTheKinematicsOfItsController)
{
  auto simulator = Controller::options();
  simulator.calibration_seed = 5;
  controller.start(simulator);
  make_robot();
  ASSERT_TRUE(becomes_ready());
  const auto calibration = robot->calibration();
  ASSERT_TRUE(calibration);
  const auto sample = *robot->latest();
  const kinematics::Joints q = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(sample.target_q.data()).array();
  const kinematics::Pose reported = kinematics::to_pose(sample.target_tcp_pose);
  EXPECT_LT(kinematics::difference(kinematics::Arm(*calibration).forward(q), reported).norm(), 1e-9);
  const kinematics::Arm nominal(kinematics::nominal_dh_parameters()[5]);
  EXPECT_GT(kinematics::difference(nominal.forward(q), reported).norm(), 1e-4);
}

struct StatedModelTest : RobotFixture {
  void make_robot_with(const std::string & model)
  {
    auto options = robot_options();
    options.model = model;
    make_robot(options);
  }
};

TEST_F(StatedModelTest, RejectsAnUnknownModelAndListsTheKnownOnes)
{
  auto options = robot_options();
  options.model = "ur99";
  try {
    Robot(options, {});
    FAIL() << "the model was accepted";
  } catch (const std::invalid_argument & error) {
    EXPECT_NE(std::string(error.what()).find("ur99"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("ur8long"), std::string::npos);
  }
}

TEST_F(StatedModelTest, AcceptsAModelWithTheSameArm)
{
  controller.start();
  make_robot_with("UR12e");
  EXPECT_TRUE(becomes_ready()) << "a UR12e reports the type of a UR10e";
}

TEST_F(StatedModelTest, PreventsMotionIfItContradictsTheController)
{
  controller.start();
  make_robot_with("ur5e");
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::model_mismatch));
  const auto message = robot->status().message;
  for (const auto & part :
       std::vector<std::string>{"ur_type is ur5e", "ur10e", own_address(), "ur_type:=ur10e"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(robot->ready_to_move().error().code, ErrorCode::model_mismatch);
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  EXPECT_TRUE(robot->io()->setStandardDigitalOut(1, true)) << "commands without motion work";
  EXPECT_TRUE(robot->latest());
  EXPECT_EQ(run_script("textmsg(\"here\")").error.code, ErrorCode::model_mismatch);
  EXPECT_EQ(controller.state().at("program").at("state"), "STOPPED");
  EXPECT_EQ(log.count("ur_type is ur5e"), 1U) << log.text();
}

TEST_F(StatedModelTest, ContradictsTheControllerOfAnotherSeries)
{
  auto simulator = Controller::options();
  simulator.model = "ur5";
  simulator.polyscope_version = "3.15.8";
  controller.start(simulator);
  make_robot_with("ur5e");
  EXPECT_TRUE(comes_to(RobotState::stopped, ErrorCode::model_mismatch));
}

TEST_F(StatedModelTest, IsComparedOnEachConnection)
{
  controller.start();
  make_robot_with("ur10e");
  ASSERT_TRUE(becomes_ready());
  controller.stop();
  ASSERT_TRUE(comes_to(RobotState::disconnected));
  auto simulator = Controller::options();
  simulator.model = "ur16e";
  controller.start(simulator);
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::model_mismatch));
  controller.stop();
  ASSERT_TRUE(comes_to(RobotState::disconnected));
  controller.start();
  EXPECT_TRUE(becomes_ready());
}

using UnknownModelTest = RobotFixture;

TEST_F(UnknownModelTest, LimitsMotionsToTheCommonLimits)
{
  controller.start();
  controller.control({{"command", "refuse_connections"}, {"which", "primary"}});
  make_robot();
  ASSERT_TRUE(becomes_ready());
  EXPECT_EQ(robot->limits().velocity, common_arm_limits().velocity);
  EXPECT_EQ(log.count("does not report the model"), 1U) << log.text();
  EXPECT_EQ(log.count("set the parameter ur_type"), 1U) << log.text();
}

TEST_F(UnknownModelTest, IsTheStatedModelWithAWarning)
{
  controller.start();
  controller.control({{"command", "refuse_connections"}, {"which", "primary"}});
  auto options = robot_options();
  options.model = "ur3e";
  make_robot(options);
  ASSERT_TRUE(becomes_ready());
  EXPECT_EQ(robot->limits().velocity, arm_limits("ur3e")->velocity);
  EXPECT_EQ(log.count("the parameter ur_type (ur3e) cannot be verified"), 1U) << log.text();
}

}  // namespace
}  // namespace ur_ros_rtde::test
