#include "urscript/library.hpp"

#include <stdexcept>

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

void Library::add_rejected(std::string name, std::vector<Parameter> parameters, std::size_t required,
                           std::string reason)
{
  Builtin builtin{std::move(name), std::move(parameters), required,
                  [reason](CallContext &, Arguments) { return Outcome(Failure{reason}); }};
  builtin.support = Support::rejected;
  builtin.note = std::move(reason);
  add(std::move(builtin));
}

void Library::simplify(std::string_view name, std::string note)
{
  Builtin & builtin = builtins_[index_of(name)];
  builtin.support = Support::simplified;
  builtin.note = std::move(note);
}

void Library::hide(std::string_view name)
{
  index_of(name);
  index_.erase(std::string(name));
}

std::uint32_t Library::index_of(std::string_view name) const
{
  const auto index = find(name);
  if (!index) {
    throw std::out_of_range("the library has no builtin '" + std::string(name) + "'");
  }
  return *index;
}

void Library::add_indexed_name(std::string name, std::string_view getter, std::string_view setter)
{
  IndexedName entry{index_of(getter), std::nullopt};
  if (!setter.empty()) {
    entry.setter = index_of(setter);
  }
  indexed_names_.insert_or_assign(std::move(name), entry);
}

const IndexedName * Library::indexed_name(const std::string & name) const
{
  const auto found = indexed_names_.find(name);
  return found == indexed_names_.end() ? nullptr : &found->second;
}

void Library::add_constant(std::string name, Value value)
{
  constants_.insert_or_assign(std::move(name), std::move(value));
}

void Library::add_end_handler(std::function<void(std::uint64_t program)> handler)
{
  end_handlers_.push_back(std::move(handler));
}

void Library::handle_end(std::uint64_t program) const
{
  for (const auto & handler : end_handlers_) {
    handler(program);
  }
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
