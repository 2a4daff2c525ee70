#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace ur_simulator::control_port {

inline nlohmann::json error_reply(const std::string & error)
{
  return {{"ok", false}, {"error", error}};
}

}  // namespace ur_simulator::control_port
