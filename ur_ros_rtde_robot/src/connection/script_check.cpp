#include "connection/script_check.hpp"

#include <utility>

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr const char * program_name = "ur_ros_rtde_check";
constexpr const char * end_of_definitions = "# HEADER_END";
constexpr int lines_before = 1;

}  // namespace

Expected<std::optional<PrimaryMessage>> check_definitions(const std::string & address,
                                                          const std::string & text, milliseconds timeout)
{
  auto primary = PrimaryConnection::connect(address, timeout);
  if (!primary) {
    return tl::unexpected(primary.error());
  }
  const std::string program =
      std::string("def ") + program_name + "():\n" + text.substr(0, text.find(end_of_definitions)) + "end\n";
  if (const auto sent = primary->send(program, timeout); !sent) {
    return tl::unexpected(sent.error());
  }
  for (const auto deadline = Clock::now() + timeout; Clock::now() < deadline;) {
    auto message = primary->next(milliseconds(20));
    if (!message) {
      return tl::unexpected(message.error());
    }
    if (!*message) {
      continue;
    }
    if ((*message)->kind == PrimaryMessage::Kind::error) {
      (*message)->line -= lines_before;
      return std::move(*message);
    }
    if ((*message)->kind == PrimaryMessage::Kind::program_stopped && (*message)->text == program_name) {
      return std::optional<PrimaryMessage>();
    }
  }
  return tl::unexpected(
      Error{ErrorCode::timeout, "the controller does not report whether it accepts the control program"});
}

}  // namespace ur_ros_rtde
