#include "client_log/client_log.hpp"

#include <algorithm>

#include "client_log/text.hpp"

namespace ur_simulator {

ClientLog::ClientLog(DiagramWriter & writer, const double & time, const std::string & robot_name)
    : writer_(writer),
      time_(time),
      suffix_(robot_name.empty() ? "" : " of " + robot_name),
      robot_(declare(robot_name.empty() ? "robot" : "robot " + robot_name))
{
}

ClientLog::~ClientLog()
{
  write_left_out(*robot_);
  for (const auto & [kind, participants] : peers_) {
    for (const auto & participant : participants) {
      write_left_out(*participant);
    }
  }
}

PeerLog ClientLog::add_peer(const std::string & kind)
{
  auto & participants = peers_[kind];
  const auto unused = std::ranges::find_if(
      participants, [](const auto & participant) { return participant.use_count() == 1; });
  if (unused != participants.end()) {
    return PeerLog(*unused);
  }
  participants.push_back(declare(fmt::format("{} {}{}", kind, participants.size() + 1, suffix_)));
  return PeerLog(participants.back());
}

void ClientLog::add_event(std::string_view text)
{
  add(*robot_, Arrow::note, text);
}

std::shared_ptr<ClientLog::Participant> ClientLog::declare(std::string name)
{
  writer_.add("participant " + name);
  return std::make_shared<Participant>(Participant{*this, std::move(name)});
}

void ClientLog::add(Participant & participant, Arrow arrow, std::string_view text)
{
  if (participant.limit.take(time_)) {
    write_left_out(participant);
    write(participant, arrow, text);
  } else {
    ++participant.left_out;
  }
}

void ClientLog::write_left_out(Participant & participant)
{
  if (const std::uint64_t count = std::exchange(participant.left_out, 0); count > 0) {
    write(participant, Arrow::note,
          fmt::format("{} lines left out: there were more than {} per second", count, line_rate));
  }
}

void ClientLog::write(const Participant & participant, Arrow arrow, std::string_view text)
{
  const std::string & robot = robot_->name;
  const std::string & peer = participant.name;
  const auto line = [&](std::string_view from, std::string_view with, std::string_view to) {
    writer_.add(fmt::format("{}{}{}: [{:.3f}] {}", from, with, to, time_,
                            escape_mermaid(printable(text, text_limit))));
  };
  switch (arrow) {
    case Arrow::from_peer:
      return line(peer, "->>", robot);
    case Arrow::to_peer:
      return line(robot, "-->>", peer);
    case Arrow::closed_by_peer:
      return line(peer, "-x", robot);
    case Arrow::closed_by_robot:
      return line(robot, "--x", peer);
    case Arrow::note:
      return &participant == robot_.get() ? line("Note over ", robot, "")
                                          : line("Note over ", robot + ",", peer);
  }
}

}  // namespace ur_simulator
