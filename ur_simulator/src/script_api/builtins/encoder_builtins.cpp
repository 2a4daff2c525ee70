#include <array>
#include <cmath>

#include "motion/arm.hpp"
#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

namespace {

/// Ranges of tick counts by range_id: 32 bits signed, 8, 16, 24 and 32 bits unsigned (script manual,
/// "encoder_enable_set_tick_count").
struct TickRange {
  double min;
  double max;
  double size() const { return max - min + 1.0; }
};
constexpr std::array<TickRange, 5> tick_ranges{
    {{-2147483648.0, 2147483647.0}, {0.0, 255.0}, {0.0, 65535.0}, {0.0, 16777215.0}, {0.0, 4294967295.0}}};

constexpr double filtered_range = 65536.0;  // encoder_get_tick_count() returns 0 to this value

/// An encoder of a conveyor. Without a conveyor its inputs give no pulses; programs set its count.
struct Encoder {
  std::optional<TickRange> range;  ///< if the program sets the count
  bool decodes_pulses = false;
  double count = 0.0;
};

using Encoders = std::array<Encoder, 2>;
using EncodersPtr = std::shared_ptr<Encoders>;

Encoder & selected_encoder(Encoders & encoders, ArgumentReader & reader)
{
  const std::int32_t index = reader.integer(0, "encoder_index");
  reader.require(index == 0 || index == 1, fmt::format("encoder_index must be 0 or 1, is {}", index));
  return encoders[reader && index == 1 ? 1 : 0];
}

Outcome decode_pulses(Encoder & encoder, ArgumentReader & reader, std::size_t type_argument,
                      const char * type_name)
{
  const std::int32_t type = reader.integer(type_argument, type_name);
  reader.require(type >= 0 && type <= 4, fmt::format("{} must be in [0, 4], is {}", type_name, type));
  for (const std::size_t input : {type_argument + 1, type_argument + 2}) {
    if (reader.given(input)) {
      const std::int32_t pin = reader.integer(input, "A, B");
      reader.require(pin >= 0 && pin <= 11, fmt::format("A and B must be in [0, 11], are {}", pin));
    }
  }
  if (!reader) {
    return reader.failure();
  }
  encoder = Encoder{};
  encoder.decodes_pulses = type != 0;
  return Value();
}

Outcome set_count(Encoder & encoder, ArgumentReader & reader, double count)
{
  reader.require(encoder.range.has_value(), "the encoder is not enabled with encoder_enable_set_tick_count");
  reader.require(!encoder.range || (count >= encoder.range->min && count <= encoder.range->max),
                 fmt::format("the count {} is outside the range of the encoder", count));
  if (!reader) {
    return reader.failure();
  }
  encoder.count = count;
  return Value();
}

Outcome enable_set_count(Encoder & encoder, ArgumentReader & reader, std::int32_t range)
{
  reader.require(range >= 0 && range < static_cast<std::int32_t>(tick_ranges.size()),
                 fmt::format("range_id must be in [0, 4], is {}", range));
  if (!reader) {
    return reader.failure();
  }
  encoder = Encoder{};
  encoder.range = tick_ranges[static_cast<std::size_t>(range)];
  return Value();
}

double filtered_count(const Encoder & encoder)
{
  const double remainder = std::fmod(encoder.count, filtered_range);
  return remainder < 0.0 ? remainder + filtered_range : remainder;
}

Outcome get_count(Encoders & encoders, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Encoder & encoder = selected_encoder(encoders, reader);
  const std::string option = reader.string(1, "opt");
  reader.require(option.empty() || option == "raw",
                 fmt::format("opt must be \"\" or \"raw\", is \"{}\"", option));
  if (!reader) {
    return reader.failure();
  }
  if (option.empty()) {
    return Value(filtered_count(encoder));
  }
  return Value(static_cast<std::int32_t>(static_cast<std::int64_t>(encoder.count)));
}

// A difference of more than half the range is taken for a wrap. Without an enabled encoder the range is
// unknown, and the result is no value.
Outcome unwind(Encoders & encoders, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Encoder & encoder = selected_encoder(encoders, reader);
  double delta = reader.number(1, "delta_tick_count");
  if (!reader) {
    return reader.failure();
  }
  if (!encoder.range && !encoder.decodes_pulses) {
    return Value();
  }
  const double size = std::min(encoder.range ? encoder.range->size() : filtered_range, filtered_range);
  if (std::abs(delta) > size / 2.0) {
    delta -= std::copysign(size, delta);
  }
  return Value(delta);
}

void add_legacy_encoder(Library & library, const EncodersPtr & encoders)
{
  library.add({"conveyor_pulse_decode",
               {"type", "A", "B"},
               2,
               [encoders](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 return decode_pulses(encoders->front(), reader, 0, "type");
               }});
  library.add({"set_conveyor_tick_count",
               {"tick_count", {"absolute_encoder_resolution", Value(0)}},
               1,
               [encoders](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const double count = reader.number(0, "tick_count");
                 const std::int32_t range = reader.integer(1, "absolute_encoder_resolution");
                 if (reader) {
                   enable_set_count(encoders->front(), reader, range);
                 }
                 return set_count(encoders->front(), reader, count);
               }});
  library.add({"get_conveyor_tick_count", {}, 0, [encoders](CallContext &, Arguments) -> Outcome {
                 return Value(filtered_count(encoders->front()));
               }});
}

}  // namespace

void add_encoder_builtins(Library & library, const RobotContextPtr & robot)
{
  const auto encoders = std::make_shared<Encoders>();
  library.add({"encoder_enable_pulse_decode",
               {"encoder_index", "decoder_type", "A", "B"},
               3,
               [encoders](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 return decode_pulses(selected_encoder(*encoders, reader), reader, 1, "decoder_type");
               }});
  library.add({"encoder_enable_set_tick_count",
               {"encoder_index", "range_id"},
               2,
               [encoders](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 Encoder & encoder = selected_encoder(*encoders, reader);
                 return enable_set_count(encoder, reader, reader.integer(1, "range_id"));
               }});
  library.add({"encoder_set_tick_count",
               {"encoder_index", "count"},
               2,
               [encoders](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 Encoder & encoder = selected_encoder(*encoders, reader);
                 return set_count(encoder, reader, reader.number(1, "count"));
               }});
  library.add({"encoder_get_tick_count",
               {"encoder_index", {"opt", Value("")}},
               1,
               [encoders](CallContext &, Arguments arguments) { return get_count(*encoders, arguments); }});
  library.add({"encoder_unwind_delta_tick_count",
               {"encoder_index", "delta_tick_count"},
               2,
               [encoders](CallContext &, Arguments arguments) { return unwind(*encoders, arguments); }});
  add_legacy_encoder(library, encoders);
  library.add({"stop_conveyor_tracking",
               {{"a", Value(20.0)}, "aRot"},
               0,
               [robot](CallContext &, Arguments arguments) -> Outcome {
                 ArgumentReader reader(arguments);
                 const double deceleration = reader.number(0, "a");
                 return reader ? start_motion(robot, [&](Arm & arm) { return arm.stop_joint(deceleration); })
                               : Outcome(reader.failure());
               }});
  for (const char * name : {"encoder_enable_pulse_decode", "conveyor_pulse_decode"}) {
    library.simplify(name, "accepted; no conveyor gives pulses");
  }
}

}  // namespace ur_simulator::script_api
