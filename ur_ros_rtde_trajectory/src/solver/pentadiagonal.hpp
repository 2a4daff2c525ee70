#pragma once

#include <cstddef>
#include <vector>

namespace ur_ros_rtde::trajectory {

/// Linear system with a symmetric positive definite matrix with two bands on each side of the diagonal.
struct Pentadiagonal {
  std::vector<double> diagonal;  ///< (i, i)
  std::vector<double> first;     ///< (i, i + 1)
  std::vector<double> second;    ///< (i, i + 2)
  std::vector<double> right;

  void clear(std::size_t size)
  {
    for (auto * band : {&diagonal, &first, &second, &right}) {
      band->assign(size, 0.0);
    }
  }

  /// Replaces `right` by the solution (L D L^T factorization in place). Returns false if the matrix is not
  /// positive definite.
  bool solve()
  {
    const std::size_t size = diagonal.size();
    for (std::size_t i = 0; i < size; ++i) {
      if (!(diagonal[i] > 0.0)) {
        return false;
      }
      const double l1 = first[i] / diagonal[i];
      const double l2 = second[i] / diagonal[i];
      if (i + 1 < size) {
        diagonal[i + 1] -= l1 * first[i];
        first[i + 1] -= l1 * second[i];
        right[i + 1] -= l1 * right[i];
      }
      if (i + 2 < size) {
        diagonal[i + 2] -= l2 * second[i];
        right[i + 2] -= l2 * right[i];
      }
      first[i] = l1;
      second[i] = l2;
    }
    for (std::size_t i = size; i-- > 0;) {
      right[i] /= diagonal[i];
      right[i] -= i + 1 < size ? first[i] * right[i + 1] : 0.0;
      right[i] -= i + 2 < size ? second[i] * right[i + 2] : 0.0;
    }
    return true;
  }
};

}  // namespace ur_ros_rtde::trajectory
