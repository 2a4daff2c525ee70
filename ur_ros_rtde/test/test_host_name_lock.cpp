#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>

#include "process/host_name_lock.hpp"

namespace ur_ros_rtde::test {
namespace {

/// A name that no other test uses at the same time.
std::string own_name(const std::string & suffix = "")
{
  return fmt::format("ur_ros_rtde_test/{}{}", ::getpid(), suffix);
}

TEST(HostNameLockTest, ReservesANameOnce)
{
  std::optional<HostNameLock> first(own_name());
  EXPECT_FALSE(first->taken_by_other());
  EXPECT_TRUE(HostNameLock(own_name()).taken_by_other());
  EXPECT_TRUE(HostNameLock(own_name()).taken_by_other()) << "a failed attempt changes nothing";
  first.reset();
  EXPECT_FALSE(HostNameLock(own_name()).taken_by_other());
}

TEST(HostNameLockTest, DistinguishesNames)
{
  const HostNameLock first(own_name());
  EXPECT_FALSE(HostNameLock(own_name("x")).taken_by_other());
}

TEST(HostNameLockTest, AcceptsLongNames)
{
  const std::string tail(300, 'x');
  const HostNameLock first(own_name(tail + "1"));
  EXPECT_FALSE(first.taken_by_other());
  EXPECT_FALSE(HostNameLock(own_name(tail + "2")).taken_by_other());
  EXPECT_TRUE(HostNameLock(own_name(tail + "1")).taken_by_other());
}

}  // namespace
}  // namespace ur_ros_rtde::test
