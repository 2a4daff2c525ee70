#include "urscript/emitter.hpp"

namespace ur_simulator::urscript {

std::uint32_t Emitter::emit(Op op, std::uint32_t a, std::uint32_t b)
{
  if (code_.instructions.size() >= limits_.instructions) {
    throw CompileError{line_, 1, "the program is too large"};
  }
  code_.instructions.push_back({op, a, b});
  code_.lines.push_back(line_);
  return here() - 1;
}

void Emitter::constant(const Value & value)
{
  const auto fresh = static_cast<std::uint32_t>(code_.constants.size());
  if (value.is(Type::integer)) {
    const auto [entry, inserted] = integers_.emplace(value.integer(), fresh);
    if (!inserted) {
      emit(Op::push_constant, entry->second);
      return;
    }
  }
  code_.constants.push_back(value);
  emit(Op::push_constant, fresh);
}

std::uint32_t Emitter::name(const std::string & name)
{
  const auto [entry, inserted] = names_.emplace(name, static_cast<std::uint32_t>(code_.names.size()));
  if (inserted) {
    code_.names.push_back(name);
  }
  return entry->second;
}

}  // namespace ur_simulator::urscript
