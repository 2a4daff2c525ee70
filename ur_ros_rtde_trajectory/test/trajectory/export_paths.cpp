// Writes random paths and their timing for the independent solvers (oracle.py): trajectory_export FILE FIRST
// COUNT JERK(0|1) STEP
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "motion/motion.hpp"
#include "random_paths.hpp"

using namespace ur_ros_rtde::trajectory;

namespace {

class Writer {
 public:
  explicit Writer(const char * name) : file_(name, std::ios::binary) {}
  void write(double value) { file_.write(reinterpret_cast<const char *>(&value), sizeof value); }
  void write(const Joints & values)
  {
    for (const double value : values) {
      write(value);
    }
  }

 private:
  std::ofstream file_;
};

// Times of the stations of one segment: the boundaries of the pieces of the path, two in each interval of the
// timing law in a blend (otherwise the independent solver exceeds the limits there), and others at most
// `step` apart; at least 300, or 40 on a line.
std::vector<double> station_times(const Motion & motion, std::size_t first, std::size_t last, double step)
{
  std::vector<double> times{motion.timing[first].start};
  const bool line = motion.timing[first].piece == motion.timing[last - 1].piece;
  const double longest = std::min(step, (motion.timing[last - 1].end() - times[0]) / (line ? 40.0 : 300.0));
  for (std::size_t k = first; k < last; ++k) {
    const TimingLawPiece & piece = motion.timing[k];
    const bool blend = motion.path->pieces[piece.piece].degree > 3;
    const bool border = k + 1 == last || motion.timing[k + 1].piece != piece.piece;
    const double since = piece.end() - times.back();
    if (blend || border || since > longest) {
      const int parts = std::max(blend ? 2 : 1, static_cast<int>(std::ceil(since / longest)));
      const double from = times.back();
      for (int n = 1; n <= parts; ++n) {
        times.push_back(from + since * n / parts);
      }
    }
  }
  return times;
}

void write_segment(Writer & writer, const Motion & motion, std::size_t first, std::size_t last, double step)
{
  const std::vector<double> times = station_times(motion, first, last, step);
  writer.write(static_cast<double>(times.size()));
  writer.write(motion.timing[last - 1].end() - motion.timing[first].start);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::size_t k = std::clamp(motion.piece_at(times[i]), first, last - 1);
    const TimingLawPiece & piece = motion.timing[k];
    const PathPiece & curve = motion.path->pieces[piece.piece];
    const PathState path_state = piece.at(std::clamp(times[i], piece.start, piece.end()));
    const PathPoint point = curve.at(std::clamp(path_state.u, 0.0, curve.length));
    writer.write(curve.start + path_state.u);
    writer.write(path_state.v * path_state.v);
    writer.write(point.d1);
    writer.write(point.d2);
    writer.write(point.d3);
  }
}

void write_path(Writer & writer, unsigned seed, bool jerk, double step)
{
  const auto path = test::random_path(seed);
  const Limits limits = test::random_limits(seed, jerk);
  const auto plan = plan_path(path.waypoints, limits, path.options);
  if (!plan) {
    std::printf("seed %u (%s): %s\n", seed, path.kind.c_str(), plan.error().message.c_str());
    return;
  }
  if (plan->duration() <= 0.0) {
    return;  // nothing but repetitions of one waypoint
  }
  const Motion & motion = plan->motion();
  const auto segments = motion.path->segments();
  writer.write(seed);
  writer.write(static_cast<double>(segments.size()));
  writer.write(limits.velocity);
  writer.write(limits.acceleration);
  writer.write(limits.jerk);
  std::size_t begin = 0;
  for (const auto & [first, last] : segments) {
    std::size_t end = begin;
    while (end < motion.timing.size() && motion.timing[end].piece < last) {
      ++end;
    }
    write_segment(writer, motion, begin, end, step);
    begin = end;
  }
}

}  // namespace

int main(int argc, char ** argv)
{
  if (argc != 6) {
    std::fprintf(stderr, "usage: trajectory_export FILE FIRST COUNT JERK(0|1) STEP\n");
    return 2;
  }
  Writer writer(argv[1]);
  const unsigned first = static_cast<unsigned>(std::atoi(argv[2]));
  const unsigned count = static_cast<unsigned>(std::atoi(argv[3]));
  for (unsigned seed = first; seed < first + count; ++seed) {
    write_path(writer, seed, std::atoi(argv[4]) != 0, std::atof(argv[5]));
  }
  return 0;
}
