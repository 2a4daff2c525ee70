#include "polyscope/controller_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string>

namespace ur_simulator {
namespace {

struct ControllerCommand {
  std::string_view text;  ///< words separated by one space
  Pendant::Result (*execute)(Pendant & pendant);
};

constexpr std::array commands{
    ControllerCommand{"power on", [](Pendant & pendant) { return pendant.power_on(); }},
    ControllerCommand{"power off", [](Pendant & pendant) { return pendant.power_off(); }},
    ControllerCommand{"set robotmode run", [](Pendant & pendant) { return pendant.release_brakes(); }},
    ControllerCommand{"set unlock protective stop",
                      [](Pendant & pendant) { return pendant.unlock_protective_stop(UnlockDelay::waived); }},
    ControllerCommand{"stop program",
                      [](Pendant & pendant) {
                        pendant.stop();
                        return Pendant::Result();
                      }},
    ControllerCommand{"pause program", [](Pendant & pendant) { return pendant.pause(); }},
    ControllerCommand{"resume program", [](Pendant & pendant) { return pendant.resume(); }},
};

/// The words of the text, separated by one space.
std::string normalize(std::string_view text)
{
  std::istringstream words{std::string(text)};
  std::string normalized;
  for (std::string word; words >> word;) {
    normalized += (normalized.empty() ? "" : " ") + word;
  }
  return normalized;
}

constexpr std::string_view set_speed = "set speed ";

/// Sets the speed slider to a fraction given as text.
Pendant::Result execute_set_speed(Pendant & pendant, std::string_view fraction_text)
{
  double fraction = 0.0;
  const char * const text_end = fraction_text.data() + fraction_text.size();
  const auto [end, error] = std::from_chars(fraction_text.data(), text_end, fraction);
  if (error != std::errc() || end != text_end || !(fraction >= 0.0 && fraction <= 1.0)) {
    return tl::make_unexpected(fmt::format("the speed is '{}': give a fraction from 0 to 1", fraction_text));
  }
  pendant.set_speed_slider(fraction);
  return {};
}

}  // namespace

std::optional<Pendant::Result> execute_controller_command(Pendant & pendant, std::string_view text)
{
  const std::string normalized = normalize(text);
  if (normalized.starts_with(set_speed)) {
    return execute_set_speed(pendant, std::string_view(normalized).substr(set_speed.size()));
  }
  const auto * const command = std::ranges::find(commands, normalized, &ControllerCommand::text);
  if (command == commands.end()) {
    return std::nullopt;
  }
  return command->execute(pendant);
}

}  // namespace ur_simulator
