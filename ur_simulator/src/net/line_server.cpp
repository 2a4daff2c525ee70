#include "net/line_server.hpp"

#include <utility>

namespace ur_simulator {

class LineServer::Session {
 public:
  Session(std::shared_ptr<Connection> connection, const LineLimit & limit, const Answer & answer)
      : connection_(std::move(connection)), limit_(limit), answer_(answer)
  {
  }

  void receive(std::string_view bytes)
  {
    received_.append(bytes);
    std::size_t begin = 0;
    for (std::size_t end = received_.find('\n'); end != std::string::npos && connection_->is_open();
         end = received_.find('\n', begin)) {
      answer(std::string_view(received_).substr(begin, end - begin));
      begin = end + 1;
    }
    received_.erase(0, begin);
    if (received_.size() > limit_.size) {
      connection_->send(limit_.reply);
      connection_->close_after_sending("the line is too long");
    }
  }

 private:
  void answer(std::string_view line)
  {
    connection_->log().from_peer("{}", line);
    const std::string reply = answer_(line, connection_);
    if (!reply.empty()) {
      connection_->log().to_peer("{}", std::string_view(reply).substr(0, reply.find_last_not_of('\n') + 1));
    }
    connection_->send(reply);
  }

  std::shared_ptr<Connection> connection_;
  const LineLimit & limit_;
  const Answer & answer_;
  std::string received_;
};

LineServer::LineServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                       LineLimit limit, Answer answer)
    : limit_(std::move(limit)),
      answer_(std::move(answer)),
      sessions_(io, address, port, [this](const std::shared_ptr<Connection> & connection) {
        return std::make_shared<Session>(connection, limit_, answer_);
      })
{
}

void LineServer::accept(const std::shared_ptr<Connection> & connection)
{
  sessions_.accept(connection);
}

}  // namespace ur_simulator
