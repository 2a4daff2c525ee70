#include "ur_ros_rtde/detail/guarded.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {

Outcome guarded(const std::function<Outcome()> & body)
{
  try {
    return body();
  } catch (const RobotError & error) {
    return error.error();
  } catch (const std::exception & error) {
    return Outcome::failure(ErrorCode::exception,
                            fmt::format("the command threw an exception: {}", printable(error.what())));
  } catch (...) {
    return Outcome::failure(ErrorCode::exception, "the command threw an exception of an unknown type");
  }
}

Outcome guarded(const StopRequest & stop_request, const std::function<Outcome()> & body)
{
  Outcome outcome = guarded(body);
  if (!outcome) {
    if (auto reason = stop_request.reason()) {
      return *std::move(reason);
    }
  }
  return outcome;
}

}  // namespace ur_ros_rtde
