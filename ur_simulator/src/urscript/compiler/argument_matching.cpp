#include "urscript/compiler/argument_matching.hpp"

namespace ur_simulator::urscript {

std::vector<std::uint32_t> match_arguments(const Expression & call, std::size_t parameters,
                                           const std::function<std::string(std::size_t)> & parameter_name,
                                           const NameTest & is_called,
                                           const std::function<void(std::string)> & fail)
{
  std::vector<std::uint32_t> given(parameters, no_argument);
  bool named = false;
  for (std::uint32_t i = 0; i < call.operands.size(); ++i) {
    const std::string & name = call.argument_names[i];
    std::size_t position = i;
    if (!name.empty()) {
      named = true;
      position = 0;
      while (position < parameters && !is_called(position, name)) {
        ++position;
      }
      if (position == parameters) {
        fail("The function '" + call.name + "' has no parameter '" + name + "'");
      }
    } else if (named) {
      fail("In the call of '" + call.name + "' a positional argument follows a named one");
    } else if (position >= parameters) {
      fail("The function '" + call.name + "' takes " + std::to_string(parameters) + " arguments, " +
           std::to_string(call.operands.size()) + " are given");
    }
    if (given[position] != no_argument) {
      fail("In the call of '" + call.name + "' the argument '" + parameter_name(position) +
           "' is given twice");
    }
    given[position] = i;
  }
  return given;
}

}  // namespace ur_simulator::urscript
