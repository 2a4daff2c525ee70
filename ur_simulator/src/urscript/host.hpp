#pragma once

#include <string>

namespace ur_simulator::urscript {

struct Popup {
  std::string message;
  std::string title = "Popup";
  bool warning = false;
  bool error = false;
  bool blocking = false;
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
};

}  // namespace ur_simulator::urscript
