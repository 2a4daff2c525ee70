#pragma once

#include <cstddef>
#include <string>

#include "urscript/machine.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::primary {

/// Program state messages (message type 25) of the primary interface: the names of the global variables of
/// the program, and their values after each change (UR, "Client Interface", and public clients of it). Names
/// and values need at most `max_size` bytes each: further variables are left out, further values have the
/// type NONE.
class GlobalVariables {
 public:
  static constexpr std::size_t max_size = 64 * 1024;

  explicit GlobalVariables(const PolyscopeVersion & version) : version_(version) {}

  /// Another program was started: changes() returns the names next.
  void begin_program() { new_program_ = true; }
  /// The messages for a new client: names and values.
  std::string all(const urscript::Machine & machine, double timestamp) const;
  /// The messages since the last call: names if the program is new, values if one has changed.
  std::string changes(const urscript::Machine & machine, double timestamp);

 private:
  std::string setup_message(const urscript::Machine & machine, double timestamp) const;
  std::string encode_values(const urscript::Machine & machine) const;

  PolyscopeVersion version_;
  bool new_program_ = true;
  std::string sent_values_;
};

}  // namespace ur_simulator::primary
