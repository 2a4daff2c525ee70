#include "dashboard/session.hpp"

#include <fmt/format.h>

#include <utility>

#include "dashboard/commands.hpp"

namespace ur_simulator::dashboard {
namespace {

constexpr std::size_t max_line_size = 16 * 1024;

}  // namespace

Session::Session(std::shared_ptr<Connection> connection, Pendant & pendant)
    : connection_(std::move(connection)),
      pendant_(pendant),
      remote_control_at_connect_(pendant.remote_control())
{
  send("Connected: Universal Robots Dashboard Server");
}

void Session::receive(std::string_view bytes)
{
  received_.append(bytes);
  std::size_t begin = 0;
  for (std::size_t end = received_.find('\n'); end != std::string::npos && !pending_reply_;
       end = received_.find('\n', begin)) {
    std::string_view line = std::string_view(received_).substr(begin, end - begin);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    begin = end + 1;
    handle_line(line);
    if (!connection_->is_open()) {
      return;
    }
  }
  received_.erase(0, begin);
  if (received_.size() > max_line_size) {
    pendant_.log().error("dashboard", fmt::format("{} sent a line of more than {} bytes: disconnected",
                                                  connection_->remote_endpoint(), max_line_size));
    connection_->close("the line is too long");
  }
}

void Session::cycle()
{
  if (pending_reply_) {
    send_pending_reply();
    if (connection_->is_open() && !pending_reply_) {
      receive({});
    }
  }
}

void Session::send(std::string_view reply)
{
  connection_->log().to_peer("{}", reply);
  connection_->send(fmt::format("{}\n", reply));
}

void Session::send_pending_reply()
{
  if (const auto reply = pending_reply_()) {
    pending_reply_ = nullptr;
    send(*reply);
  }
}

bool Session::is_rejected(bool requires_remote_control) const
{
  const bool local_control = !pendant_.remote_control() || !remote_control_at_connect_;
  return requires_remote_control && local_control && pendant_.options().version.is_e_series();
}

void Session::handle_line(std::string_view line)
{
  std::string_view argument;
  connection_->log().from_peer("{}", line);
  const Command * command = find_command(line, pendant_.options().version, argument);
  if (command == nullptr) {
    send(fmt::format("could not understand: '{}'", line));
    return;
  }
  if (is_rejected(command->requires_remote_control)) {
    send(
        "Command is not allowed due to safety reasons, please switch robot to Remote Control mode and "
        "reconnect to port 29999");
    return;
  }
  if (command->start != nullptr) {
    pending_reply_ = command->start(pendant_, argument);
    send_pending_reply();
    return;
  }
  send(command->execute(pendant_, argument));
  if (command->name == "quit") {
    connection_->close_after_sending("quit");
  }
}

}  // namespace ur_simulator::dashboard
