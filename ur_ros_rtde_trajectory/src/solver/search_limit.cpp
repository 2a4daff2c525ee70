#include "solver/search_limit.hpp"

#include <ctime>

namespace ur_ros_rtde::trajectory {

double thread_time()
{
  std::timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace ur_ros_rtde::trajectory
