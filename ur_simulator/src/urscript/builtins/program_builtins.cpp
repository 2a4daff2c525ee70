#include <chrono>
#include <cmath>

#include "urscript/argument_reader.hpp"
#include "urscript/builtins/builtins.hpp"

namespace ur_simulator::urscript {

namespace {

/// Waits for a number of control cycles.
class Sleep : public PendingCall {
 public:
  explicit Sleep(double cycles) : left_(cycles) {}

  tl::expected<std::optional<Value>, std::string> poll(CallContext &) override
  {
    left_ -= 1.0;
    // Half a cycle of tolerance for the rounding of the division: 0.01 s are five cycles of 2 ms.
    return left_ < 0.5 ? std::optional<Value>(Value()) : std::nullopt;
  }

 private:
  double left_;
};

Outcome sleep(CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double time = reader.number(0, "t");
  reader.require(time >= 0.0, fmt::format("t must not be negative, is {} s", time));
  if (!reader) {
    return reader.failure();
  }
  if (time == 0.0) {
    return Value();
  }
  return std::make_unique<Sleep>(time / context.cycle_time);
}

/// Waits until the operator has closed the popup.
class PopupWait : public PendingCall {
 public:
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    return context.host.popup_open() ? std::nullopt : std::optional<Value>(Value());
  }
};

Outcome popup(CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Popup popup{reader.value(0).text(), reader.value(1).text(), reader.boolean(2, "warning"),
                    reader.boolean(3, "error"), reader.boolean(4, "blocking")};
  if (!reader) {
    return reader.failure();
  }
  context.host.show_popup(popup);
  if (popup.blocking) {
    return std::make_unique<PopupWait>();
  }
  return Value();
}

/// Waits until the operator has entered a value.
class AnswerWait : public PendingCall {
 public:
  explicit AnswerWait(ValueRequest request) : request_(std::move(request)) {}

  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    if (!number_) {
      number_ = context.host.show_request(request_);
    }
    return number_ ? context.host.take_answer(*number_) : std::nullopt;
  }

 private:
  ValueRequest request_;
  std::optional<std::uint64_t> number_;  ///< once it is shown
};

template <Type type>
Outcome request_value(CallContext &, Arguments arguments)
{
  const std::string message = arguments[0].text();
  if (message.empty()) {
    return Failure{"the message must not be empty"};
  }
  return std::make_unique<AnswerWait>(ValueRequest{type, message});
}

Outcome textmsg(CallContext & context, Arguments arguments)
{
  std::string text = arguments[0].text(TextFormat::message);
  if (!arguments[1].is(Type::none)) {
    text += arguments[1].text(TextFormat::message);
  }
  context.host.text_message(text);
  return Value();
}

// Mode 0: monotonic time since the controller started, the same in every run. Mode 2: time since the epoch.
// (UR script manual, time(); mode 1 is reserved.)
Outcome time(CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t mode = reader.integer(0, "mode");
  reader.require(mode == 0 || mode == 2, fmt::format("mode must be 0 (monotonic) or 2 (UTC), is {}", mode));
  if (!reader) {
    return reader.failure();
  }
  const std::chrono::duration<double> utc = std::chrono::system_clock::now().time_since_epoch();
  const double now = mode == 0 ? context.time : utc.count();
  const double seconds = std::floor(now);
  Structure result;
  result.members.emplace_back("sec", Value(static_cast<std::int32_t>(seconds)));
  result.members.emplace_back("nanosec", Value(static_cast<std::int32_t>((now - seconds) * 1e9)));
  return Value(std::move(result));
}

}  // namespace

void add_program_builtins(Library & library)
{
  library.add({"sync", {}, 0, [](CallContext &, Arguments) -> Outcome { return NextCycle{}; }});
  library.add({"sleep", {"t"}, 1, sleep});
  library.add({"halt", {}, 0, [](CallContext &, Arguments) -> Outcome { return Halt{}; }});
  library.add({"textmsg", {"s1", "s2"}, 1, textmsg});
  library.add({"popup",
               {"s",
                {"title", Value("Popup")},
                {"warning", Value(false)},
                {"error", Value(false)},
                {"blocking", Value(false)}},
               1,
               popup});
  library.add_constant("None", Value());
  library.add({"time", {{"mode", Value(0)}}, 0, time});
  library.add({"request_boolean_from_primary_client", {"message"}, 1, request_value<Type::boolean>});
  library.add({"request_float_from_primary_client", {"message"}, 1, request_value<Type::floating>});
  library.add({"request_integer_from_primary_client", {"message"}, 1, request_value<Type::integer>});
  library.add({"request_string_from_primary_client", {"message"}, 1, request_value<Type::string>});
}

void add_standard_builtins(Library & library)
{
  add_math_builtins(library);
  add_pose_builtins(library);
  add_list_builtins(library);  // after the poses: inv() also takes poses
  add_string_builtins(library);
  add_program_builtins(library);
}

}  // namespace ur_simulator::urscript
