#include "ur_ros_rtde/supervision.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

#include "ur_ros_rtde_robot/connection/text.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

Supervision::Supervision(CommandHost & host, const StopOptions & options, WhileReasonPersists next,
                         Condition condition)
    : host_(host),
      options_(options),
      next_(next),
      condition_(std::move(condition)),
      thread_([this](const std::stop_token & stop) { watch(stop); })
{
}

Supervision::~Supervision()
{
  end();
  thread_.join();
}

void Supervision::watch(const std::stop_token & stop)
{
  constexpr std::chrono::milliseconds timeout{100};
  bool is_stopped = false;  // by the present reason
  for (Sample sample{}; !stop.stop_requested();) {
    if (!host_.robot().wait_for_next(sample, timeout, stop)) {
      continue;
    }
    const auto why = evaluate(sample);
    const bool rejects = next_ == WhileReasonPersists::reject || has_thrown_;
    host_.set_hindrance(this, rejects ? why : std::nullopt);
    if (why && !is_stopped) {
      host_.begin_stop(options_, *why);
      RCL_CXX_WARN(host_.node().get_logger(), "the arm is stopped: {}", why->message);
    } else if (!why && is_stopped) {
      RCL_CXX_INFO(host_.node().get_logger(), "a supervision no longer has a reason to stop the arm");
    }
    is_stopped = why.has_value();
  }
  host_.set_hindrance(this, std::nullopt);
}

std::optional<Error> Supervision::evaluate(const Sample & sample)
{
  has_thrown_ = true;
  try {
    auto why = condition_(sample);
    has_thrown_ = false;
    return why;
  } catch (const std::exception & error) {
    return Error{ErrorCode::exception, fmt::format("a supervision threw: {}", printable(error.what()))};
  } catch (...) {
    return Error{ErrorCode::exception, "a supervision threw an exception of an unknown type"};
  }
}

}  // namespace ur_ros_rtde
