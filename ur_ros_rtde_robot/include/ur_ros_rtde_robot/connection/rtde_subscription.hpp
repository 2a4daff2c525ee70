#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Receives arbitrary RTDE outputs of a controller, including those that are not part of Sample, over a
/// separate connection. Values of all types are returned as doubles, which is exact except for integers
/// beyond 2^53; BOOL is 0 or 1.
class RtdeSubscription {
 public:
  using Clock = std::chrono::steady_clock;

  struct Field {
    std::string name;
    std::size_t size;  ///< number of values: 6 for "actual_q"
  };

  /// `frequency`: Hz; 0 or a rate above the controller's maximum selects the maximum. `timeout`: timeout of
  /// each step of connecting. Errors: link_lost; not_supported, naming the fields that this controller lacks.
  static Expected<RtdeSubscription> open(const std::string & address, const std::vector<std::string> & fields,
                                         double frequency,
                                         std::chrono::milliseconds timeout = std::chrono::milliseconds(500));
  RtdeSubscription(RtdeSubscription &&) noexcept;
  RtdeSubscription & operator=(RtdeSubscription &&) noexcept;
  ~RtdeSubscription();

  /// In the requested order.
  const std::vector<Field> & fields() const;
  /// Number of values in a package.
  std::size_t width() const;
  /// Hz, as agreed with the controller.
  double frequency() const;
  /// See ur_ros_rtde::silence_limit().
  std::chrono::milliseconds silence_limit(std::chrono::milliseconds limit) const;

  /// Waits for the next package and writes its width() values, one field after the other; false if none
  /// arrives before the deadline. Does not allocate in steady state. Errors: link_lost.
  Expected<bool> next(std::span<double> numbers, Clock::time_point deadline);

 private:
  class Impl;
  explicit RtdeSubscription(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// How long RTDE packages of this frequency in Hz may stay out before the connection counts as lost: `limit`,
/// but at least 5 periods.
std::chrono::milliseconds silence_limit(std::chrono::milliseconds limit, double frequency);

}  // namespace ur_ros_rtde
