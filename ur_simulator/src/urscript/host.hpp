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

/// What a program may ask of the controller that is no builtin of the robot: its messages and its operator.
/// Called on the thread that runs the machine. The defaults ignore messages and answer questions at once, as
/// with nobody at the teach pendant.
class Host {
 public:
  virtual ~Host() = default;
  /// textmsg(): for the log, as it arrives on the primary interface.
  virtual void text_message(const std::string &) {}
  virtual void show_popup(const Popup &) {}
  /// A blocking popup() ends when this turns false.
  virtual bool popup_open() const { return false; }
};

}  // namespace ur_simulator::urscript
