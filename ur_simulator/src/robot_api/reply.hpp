#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace ur_simulator::robot_api {

/// What a client receives.
struct Reply {
  unsigned status = 200;
  std::string body = {};
  std::string content_type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< further headers
};

Reply json_reply(unsigned status, const nlohmann::json & body);
/// The schema APIError.
Reply error_reply(unsigned status, std::string_view message, std::string_view details);
/// The schema HTTPValidationError: what is wrong with a part of the request, for example {"body", "action"}.
Reply validation_error(std::vector<std::string> location, std::string_view message);

/// A reply that may take several control cycles. Polled once per cycle; nullopt until it is available.
using PendingReply = std::function<std::optional<Reply>()>;
using Answer = std::variant<Reply, PendingReply>;

}  // namespace ur_simulator::robot_api
