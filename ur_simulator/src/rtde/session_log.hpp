#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "client_log/client_log.hpp"
#include "rtde/fields.hpp"

namespace ur_simulator::rtde {

/// The data packages of an input recipe in the client log: the first one, and later ones whose values differ
/// from those that were logged last, up to a rate. The others are counted.
class DataPackageLog {
 public:
  /// `values`: the payload without the recipe id. `time`: s.
  void add(const PeerLog & log, unsigned recipe_id, std::span<const InputField * const> fields,
           std::string_view values, double time);

 private:
  /// The changed values, such as "input_int_register_0=1, input_double_register_0=0.2".
  std::string changes(std::span<const InputField * const> fields, std::string_view values) const;

  RateLimit limit_{10.0, 2.0};
  std::string logged_values_;
  std::uint64_t not_logged_ = 0;  ///< packages since then
};

/// Logs the reply to a recipe: its number and the types of its fields, or if the number is 0 the fields
/// because of which it is rejected.
void log_recipe_reply(const PeerLog & log, unsigned recipe_id, std::string_view names,
                      std::string_view types);

}  // namespace ur_simulator::rtde
