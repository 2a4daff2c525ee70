#include <gtest/gtest.h>

#include <rcl_cxx/node.hpp>
#include <system_error>

#include "nodes/server.hpp"
#include "process/process.hpp"

namespace ur_ros_rtde {
namespace {

/// Cannot create a thread, for example.
class FailingServer : public Server {
 public:
  explicit FailingServer(const rcl_cxx::Context::SharedPtr & context) : node_(context, "failing") {}
  rcl_cxx::Node & node() override { return node_; }
  void create_actions() override
  {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again), "no thread");
  }
  void start() override {}

 private:
  rcl_cxx::Node node_;
};

TEST(ProcessTest, FailsIfANodeCannotStart)
{
  std::string name = "test_process";
  char * arguments[] = {name.data(), nullptr};
  testing::internal::CaptureStderr();
  const int code = run_process(1, arguments, [](const rcl_cxx::Context::SharedPtr & context) {
    Servers servers;
    servers.push_back(std::make_unique<FailingServer>(context));
    return servers;
  });
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_EQ(code, 1);
  EXPECT_NE(printed.find("no thread"), std::string::npos) << printed;
}

}  // namespace
}  // namespace ur_ros_rtde
