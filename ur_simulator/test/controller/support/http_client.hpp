#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tcp_client.hpp"

namespace ur_simulator::testing {

struct HttpReply {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;

  nlohmann::json json() const { return nlohmann::json::parse(body); }
};

/// A client of the Robot API that keeps its connection.
class HttpClient {
 public:
  static constexpr const char * base_path = "/universal-robots/robot-api";

  HttpClient(const std::string & address, std::uint16_t port) : socket_(address, port) {}

  HttpReply get(const std::string & path) { return request("GET", path); }
  HttpReply put(const std::string & path, const nlohmann::json & body, std::chrono::seconds timeout = limit)
  {
    return request("PUT", path, body.dump(), "application/json", timeout);
  }
  HttpReply post(const std::string & path, const nlohmann::json & body)
  {
    return request("POST", path, body.dump(), "application/json");
  }
  HttpReply send_file(const std::string & method, const std::string & path, const std::string & content)
  {
    const std::string part =
        "Content-Disposition: form-data; name=\"file\"; filename=\"filename\"\r\n"
        "Content-Type: text/plain\r\n\r\n" +
        content;
    return request(method, path, "--xyz\r\n" + part + "\r\n--xyz--\r\n", "multipart/form-data; boundary=xyz");
  }
  HttpReply request(const std::string & method, const std::string & path, const std::string & body = "",
                    const std::string & content_type = "application/json",
                    std::chrono::seconds timeout = limit)
  {
    socket_.send(method + " " + base_path + path + " HTTP/1.1\r\nHost: robot\r\nContent-Type: " +
                 content_type + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return receive(method != "HEAD", timeout);
  }
  HttpReply receive(bool with_body = true, std::chrono::seconds timeout = limit)
  {
    HttpReply reply;
    const std::string status_line = socket_.receive_line(timeout);
    reply.status = std::stoi(status_line.substr(status_line.find(' ')));
    for (std::string line = header_line(); !line.empty(); line = header_line()) {
      const std::size_t colon = line.find(':');
      std::string name = line.substr(0, colon);
      std::ranges::transform(name, name.begin(),
                             [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      reply.headers[name] = line.substr(colon + 2);
    }
    if (with_body && reply.headers.contains("content-length")) {
      reply.body = socket_.receive(std::stoul(reply.headers["content-length"]), timeout);
    }
    return reply;
  }
  TcpClient & socket() { return socket_; }

 private:
  static constexpr std::chrono::seconds limit{20};

  std::string header_line()
  {
    std::string line = socket_.receive_line();
    return line.substr(0, line.size() - 1);  // without '\r'
  }

  TcpClient socket_;
};

}  // namespace ur_simulator::testing
