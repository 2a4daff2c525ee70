#include "urscript/compiler/emitter.hpp"

namespace ur_simulator::urscript {

std::uint32_t Emitter::emit(Opcode op, std::uint32_t a, std::uint32_t b)
{
  if (code_.instructions.size() >= limits_.instructions) {
    throw CompileError{line_, 1, "the program is too large"};
  }
  code_.instructions.push_back({op, a, b});
  code_.lines.push_back(line_);
  return next_index() - 1;
}

void Emitter::emit_constant(const Value & value)
{
  const auto new_index = static_cast<std::uint32_t>(code_.constants.size());
  if (value.is(Type::integer)) {
    const auto [entry, inserted] = integers_.emplace(value.integer(), new_index);
    if (!inserted) {
      emit(Opcode::push_constant, entry->second);
      return;
    }
  }
  code_.constants.push_back(value);
  emit(Opcode::push_constant, new_index);
}

std::uint32_t Emitter::name_index(const std::string & name)
{
  const auto [entry, inserted] = names_.emplace(name, static_cast<std::uint32_t>(code_.names.size()));
  if (inserted) {
    code_.names.push_back(name);
  }
  return entry->second;
}

}  // namespace ur_simulator::urscript
