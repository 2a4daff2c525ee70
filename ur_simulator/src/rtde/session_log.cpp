#include "rtde/session_log.hpp"

#include <algorithm>
#include <vector>

namespace ur_simulator::rtde {
namespace {

/// The value of an input. Inputs have no other types.
std::string value_text(FieldType type, std::string_view bytes)
{
  PackageReader reader(bytes);
  switch (type) {
    case FieldType::boolean:
    case FieldType::uint8:
      return fmt::to_string(reader.read_u8());
    case FieldType::uint32:
      return fmt::to_string(reader.read_u32());
    case FieldType::int32:
      return fmt::to_string(reader.read_i32());
    case FieldType::double_:
      return fmt::format("{:.5g}", reader.read_f64());
    default:
      return fmt::format("[{:.5g}]", fmt::join(reader.read_vector6(), ", "));
  }
}

}  // namespace

void DataPackageLog::add(const PeerLog & log, unsigned recipe_id, std::span<const InputField * const> fields,
                         std::string_view values, double time)
{
  if (values == logged_values_ || !limit_.take(time)) {
    ++not_logged_;
    return;
  }
  const std::string others = not_logged_ > 0 ? fmt::format(", after {} others", not_logged_) : "";
  log.from_peer("data package of recipe {}{}: {}", recipe_id, others, changes(fields, values));
  logged_values_ = values;
  not_logged_ = 0;
}

std::string DataPackageLog::changes(std::span<const InputField * const> fields, std::string_view values) const
{
  std::vector<std::string> texts;
  std::size_t begin = 0;
  for (const InputField * field : fields) {
    const std::size_t size = encoded_size(field->type);
    if (begin + size > values.size()) {
      break;
    }
    const std::string_view value = values.substr(begin, size);
    if (begin + size > logged_values_.size() ||
        value != std::string_view(logged_values_).substr(begin, size)) {
      texts.push_back(fmt::format("{}={}", field->name, value_text(field->type, value)));
    }
    begin += size;
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

void log_recipe_reply(const PeerLog & log, unsigned recipe_id, std::string_view names, std::string_view types)
{
  if (!log || recipe_id != 0) {
    log.to_peer("accepted as recipe {}: {}", recipe_id, types);
    return;
  }
  const std::vector<std::string_view> all_names = split_names(names);
  const std::vector<std::string_view> all_types = split_names(types);
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < std::min(all_names.size(), all_types.size()); ++i) {
    if (all_types[i] == "NOT_FOUND" || all_types[i] == "IN_USE") {
      reasons.push_back(fmt::format("{} {}", all_names[i], all_types[i]));
    }
  }
  log.to_peer("rejected: {}", fmt::join(reasons, ", "));
}

}  // namespace ur_simulator::rtde
