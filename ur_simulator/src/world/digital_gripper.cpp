#include "world/digital_gripper.hpp"

#include <algorithm>

namespace ur_simulator {
namespace {

constexpr std::uint64_t close_output = std::uint64_t{1} << 16;  // tool output 0
constexpr std::uint64_t open_output = std::uint64_t{1} << 17;   // tool output 1
constexpr std::uint64_t object_input = std::uint64_t{1} << 16;  // tool input 0
constexpr std::uint64_t open_input = std::uint64_t{1} << 17;    // tool input 1
constexpr std::int32_t supply_voltage = 24;                     // V

}  // namespace

void DigitalGripper::step(double duration, Io & io)
{
  const bool powered = io.tool_output_voltage == supply_voltage;
  const bool close = powered && (io.digital_outputs & close_output) != 0;
  const bool open = double_acting_ ? powered && (io.digital_outputs & open_output) != 0 : !close;
  const double step = air_ ? speed * duration : 0.0;
  bool blocked = false;
  if (close && !open) {
    const double end = object_ > 0.0 && width_ >= object_ ? object_ : 0.0;
    width_ = std::max(end, width_ - step);
    blocked = end > 0.0 && width_ == end;
  } else if (open && !close) {
    width_ = std::min(stroke, width_ + step);
  }
  io.digital_inputs &= ~(object_input | open_input);
  if (powered) {
    io.digital_inputs |= (blocked ? object_input : 0) | (width_ == stroke ? open_input : 0);
  }
}

}  // namespace ur_simulator
