#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Any RTDE outputs of a controller, on a connection of their own: also those that a Sample does not hold.
/// Numbers of all types are given as doubles, which is exact but for integers beyond 2^53; BOOL is 0 or 1.
class RtdeStream {
 public:
  using Clock = std::chrono::steady_clock;

  struct Field {
    std::string name;
    std::size_t size;  ///< numbers: 6 of "actual_q"
  };

  /// `frequency`: Hz; 0, or more than the controller can: what it can. `limit`: for each step of connecting.
  /// Errors: link_lost; not_supported, naming the fields that this controller does not have.
  static Expected<RtdeStream> open(const std::string & address, const std::vector<std::string> & fields,
                                   double frequency,
                                   std::chrono::milliseconds limit = std::chrono::milliseconds(500));
  RtdeStream(RtdeStream &&) noexcept;
  RtdeStream & operator=(RtdeStream &&) noexcept;
  ~RtdeStream();

  /// In the order in which they were asked for.
  const std::vector<Field> & fields() const;
  /// Numbers in a package.
  std::size_t width() const;
  /// Hz, agreed.
  double frequency() const;

  /// Waits for the next package and writes its numbers, width() of them, one field after the other; false
  /// when there was none until the deadline. Allocates nothing once it runs. Errors: link_lost.
  Expected<bool> next(std::span<double> numbers, Clock::time_point deadline);

 private:
  class Impl;
  explicit RtdeStream(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
