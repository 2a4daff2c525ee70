#include "script_api/program_sockets.hpp"

namespace ur_simulator::script_api {

std::shared_ptr<ScriptSocket> ProgramSockets::open(std::uint64_t program, const std::string & name,
                                                   const std::string & address, std::uint16_t port)
{
  close(program, name);
  if (sockets_.size() == limit) {
    return nullptr;
  }
  return sockets_[{program, name}] = open_(address, port);
}

std::shared_ptr<ScriptSocket> ProgramSockets::find(std::uint64_t program, const std::string & name) const
{
  const auto found = sockets_.find({program, name});
  return found == sockets_.end() ? nullptr : found->second;
}

void ProgramSockets::close(std::uint64_t program, const std::string & name)
{
  sockets_.erase({program, name});
}

void ProgramSockets::close_all(std::uint64_t program)
{
  std::erase_if(sockets_, [program](const auto & socket) { return socket.first.first == program; });
}

}  // namespace ur_simulator::script_api
