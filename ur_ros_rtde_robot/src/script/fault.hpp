#pragma once

#include <string>
#include <tl/expected.hpp>

namespace ur_ros_rtde::script {

/// An error in a script.
struct Fault {
  int line = 0;  ///< from 1; 0: not related to a line
  std::string message;
};

template <class T>
using Result = tl::expected<T, Fault>;

inline tl::unexpected<Fault> fault(int line, std::string message)
{
  return tl::unexpected<Fault>(Fault{line, std::move(message)});
}

}  // namespace ur_ros_rtde::script
