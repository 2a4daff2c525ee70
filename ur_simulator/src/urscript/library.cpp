#include "urscript/library.hpp"

namespace ur_simulator::urscript {

void Library::add(Builtin builtin)
{
  const auto new_index = static_cast<std::uint32_t>(builtins_.size());
  const auto [entry, inserted] = index_.emplace(builtin.name, new_index);
  if (inserted) {
    builtins_.push_back(std::move(builtin));
  } else {
    builtins_[entry->second] = std::move(builtin);
  }
}

void Library::add_constant(std::string name, Value value)
{
  constants_.insert_or_assign(std::move(name), std::move(value));
}

std::optional<std::uint32_t> Library::find(std::string_view name) const
{
  const auto found = index_.find(std::string(name));
  return found == index_.end() ? std::nullopt : std::optional(found->second);
}

const Value * Library::constant(const std::string & name) const
{
  const auto found = constants_.find(name);
  return found == constants_.end() ? nullptr : &found->second;
}

}  // namespace ur_simulator::urscript
