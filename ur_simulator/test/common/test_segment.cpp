#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/segment.hpp"

namespace ur_simulator {
namespace {

constexpr int samples = 400;

class SegmentTest : public ::testing::Test {
 protected:
  Vector3 point()
  {
    return Vector3::NullaryExpr([this] { return coordinate_(engine_); });
  }
  Segment segment() { return {point(), point()}; }

 private:
  std::mt19937_64 engine_{1};
  std::uniform_real_distribution<double> coordinate_{-1.0, 1.0};
};

Vector3 point_on(const Segment & segment, int sample)
{
  return segment.begin + static_cast<double>(sample) / samples * (segment.end - segment.begin);
}

double point_distance(const Vector3 & point, const Vector3 & half_size)
{
  return (point.cwiseAbs() - half_size).cwiseMax(0.0).norm();
}

TEST_F(SegmentTest, DistanceOfSegmentsIsTheLeastOfTheirPoints)
{
  for (int i = 0; i < 100; ++i) {
    const Segment a = segment();
    const Segment b = segment();
    double least = 10.0;
    for (int j = 0; j <= samples; ++j) {
      for (int k = 0; k <= samples; ++k) {
        least = std::min(least, (point_on(a, j) - point_on(b, k)).norm());
      }
    }
    EXPECT_LE(distance(a, b), least + 1e-12);
    EXPECT_NEAR(distance(a, b), least, 0.01);
    EXPECT_NEAR(distance(a, b), distance(b, a), 1e-12);
  }
}

TEST_F(SegmentTest, DistanceOfParallelSegmentsAndPoints)
{
  const Segment along_x{{0, 0, 0}, {1, 0, 0}};
  EXPECT_NEAR(distance(along_x, {{0.2, 0.3, 0}, {0.7, 0.3, 0}}), 0.3, 1e-12);
  EXPECT_NEAR(distance(along_x, {{0.7, 0.3, 0}, {0.2, 0.3, 0}}), 0.3, 1e-12);
  EXPECT_NEAR(distance(along_x, {{4, 4, 0}, {5, 4, 0}}), 5.0, 1e-12);
  EXPECT_NEAR(distance(along_x, {{-5, 4, 0}, {-3, 4, 0}}), 5.0, 1e-12);
  EXPECT_NEAR(distance(along_x, {{0.5, 0, 2}, {0.5, 0, 2}}), 2.0, 1e-12);
  EXPECT_NEAR(distance({{0.5, 0, 2}, {0.5, 0, 2}}, along_x), 2.0, 1e-12);
  EXPECT_NEAR(distance({{0, 0, 2}, {0, 0, 2}}, {{0, 0, 1}, {0, 0, 1}}), 1.0, 1e-12);
  EXPECT_NEAR(distance(along_x, {{0.5, -1, 0}, {0.5, 1, 0}}), 0.0, 1e-12);
}

TEST_F(SegmentTest, DistanceFromABoxIsTheLeastOfItsPoints)
{
  for (int i = 0; i < 2000; ++i) {
    const Segment tested = segment();
    const Vector3 half_size = 0.5 * point().cwiseAbs();
    double least = 10.0;
    for (int j = 0; j <= samples; ++j) {
      least = std::min(least, point_distance(point_on(tested, j), half_size));
    }
    EXPECT_LE(distance_from_box(tested, half_size), least + 1e-12);
    EXPECT_NEAR(distance_from_box(tested, half_size), least, 0.005);
  }
}

TEST_F(SegmentTest, DistanceFromABoxOfParallelSegmentsAndPoints)
{
  const Vector3 half_size(0.5, 0.5, 0.5);
  EXPECT_NEAR(distance_from_box({{-2, 0, 0.8}, {2, 0, 0.8}}, half_size), 0.3, 1e-12);
  EXPECT_NEAR(distance_from_box({{-2, 0, 0.2}, {2, 0, 0.2}}, half_size), 0.0, 1e-12);
  EXPECT_NEAR(distance_from_box({{1, 1, 0}, {1, 1, 0}}, half_size), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(distance_from_box({{-2, 0, 0.5}, {2, 0, 0.5}}, half_size), 0.0, 1e-12);
}

}  // namespace
}  // namespace ur_simulator
