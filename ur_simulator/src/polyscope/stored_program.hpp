#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace ur_simulator {

/// The host from which the External Control URCap requests its program.
struct ProgramHost {
  std::string address;
  std::uint16_t port = 50002;
};

/// A program on the controller's disk.
struct StoredProgram {
  std::string script;                                ///< with external_control: what follows its node
  std::optional<ProgramHost> external_control = {};  ///< set: a program of the External Control URCap
  std::string document = {};     ///< the file of PolyScope X from which the script was read
  std::string description = {};  ///< PolyScope X only, like the dates
  std::int64_t created = 0;      ///< ms since 1970; 0: unknown
  std::int64_t saved = 0;        ///< likewise
};

}  // namespace ur_simulator
