#include "primary/script_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ur_simulator::primary {
namespace {

/// Logs the first line of a script, and its size if it has further lines.
void log_script(const PeerLog & log, std::string_view script)
{
  if (!log) {
    return;
  }
  const auto lines = std::ranges::count(script, '\n');
  const std::string_view first_line = script.substr(0, script.find_first_of("\r\n"));
  if (lines <= 1) {
    log.from_peer("{}", first_line);
  } else {
    log.from_peer("script of {} lines, {} bytes: {}", lines, script.size(), first_line);
  }
}

}  // namespace

ScriptSession::ScriptSession(std::shared_ptr<Connection> connection, Pendant & pendant, ScriptAccess access)
    : connection_(std::move(connection)), pendant_(pendant), access_(access)
{
}

void ScriptSession::receive(std::string_view bytes)
{
  reader_.feed(bytes);
  log_dropped_scripts();
  while (const auto script = reader_.next()) {
    log_script(connection_->log(), *script);
    if (const Pendant::Result result = run(*script)) {
      connection_->log().note("accepted");
    } else {
      connection_->log().note("rejected: {}", result.error());
    }
  }
}

Pendant::Result ScriptSession::run(std::string_view script)
{
  // Errors are logged and reported to the clients of the primary interface.
  if (access_ == ScriptAccess::full) {
    return pendant_.run_script(script);
  }
  constexpr const char * reason = "it was sent to a read-only interface";
  pendant_.log().error("program", error_codes::read_only_interface,
                       fmt::format("script was not started: {}", reason));
  return tl::make_unexpected(reason);
}

void ScriptSession::log_dropped_scripts()
{
  const std::uint64_t dropped = reader_.dropped();
  if (dropped != dropped_scripts_) {
    dropped_scripts_ = dropped;
    connection_->log().note("a script was dropped: it is too long");
    pendant_.log().error("program", fmt::format("a script from {} was dropped: it is too long",
                                                connection_->remote_endpoint()));
  }
}

}  // namespace ur_simulator::primary
