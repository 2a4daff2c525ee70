#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "urscript/value.hpp"

namespace ur_simulator::urscript {

struct Popup {
  std::string message;
  std::string title = "Popup";
  bool warning = false;
  bool error = false;
  bool blocking = false;
};

/// A value that the operator is asked to enter: a bool, int, float or string.
struct ValueRequest {
  Type type;
  std::string message;
};

/// Receives the messages and popups of a program. Called on the thread that runs the machine. The defaults
/// ignore messages and close popups at once.
class Host {
 public:
  virtual ~Host() = default;
  /// textmsg(): a message for the log and the primary interface.
  virtual void text_message(const std::string &) {}
  virtual void show_popup(const Popup &) {}
  /// A blocking popup() returns when this is false.
  virtual bool popup_open() const { return false; }
  /// Shows a request. Returns its number, or nothing while another one is open.
  virtual std::optional<std::uint64_t> show_request(const ValueRequest &) { return std::nullopt; }
  /// The answer to this request, once.
  virtual std::optional<Value> take_answer(std::uint64_t) { return std::nullopt; }
};

}  // namespace ur_simulator::urscript
