#include "primary/interpreter_server.hpp"

namespace ur_simulator::primary {

namespace {

constexpr std::size_t max_statement_size = 64 << 10;  // bytes

}  // namespace

InterpreterServer::InterpreterServer(boost::asio::io_context & io, const std::string & address,
                                     std::uint16_t port, Pendant & pendant, InterpreterMode & mode)
    : pendant_(pendant),
      mode_(mode),
      server_(io, address, port, {max_statement_size, "discard: the line is too long: \n"},
              [this](std::string_view line, const std::shared_ptr<Connection> & client) {
                receive(line, client);
                return std::string();
              })
{
}

void InterpreterServer::cycle()
{
  mode_.set_program_running(pendant_.runner().running());
  mode_.begin_cycle();
}

void InterpreterServer::receive(std::string_view line, const std::shared_ptr<Connection> & client)
{
  mode_.set_program_running(pendant_.runner().running());
  mode_.receive(line, [weak = std::weak_ptr(client)](const std::string & reply) {
    if (const auto connection = weak.lock()) {
      connection->log().to_peer("{}", reply.substr(0, reply.find('\n')));
      connection->send(reply);
    }
  });
}

}  // namespace ur_simulator::primary
