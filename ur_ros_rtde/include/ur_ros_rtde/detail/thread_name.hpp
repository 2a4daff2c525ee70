#pragma once

#include <pthread.h>

#include <string>

namespace ur_ros_rtde {

/// Names the calling thread, for debuggers, `top -H` and tests. The system keeps 15 characters.
inline void name_thread(const std::string & name)
{
  pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());
}

}  // namespace ur_ros_rtde
