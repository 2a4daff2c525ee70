#pragma once

#include <string>

namespace ur_simulator::robot_api {

/// A complete request of a client.
struct HttpRequest {
  std::string method;  ///< "GET", "PUT", …
  std::string target;  ///< path and query
  std::string content_type;
  std::string body;
};

}  // namespace ur_simulator::robot_api
