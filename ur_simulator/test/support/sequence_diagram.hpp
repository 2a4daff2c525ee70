#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace ur_simulator::testing {

/// Reads a sequence diagram. Each line must have a form that Mermaid reads, and all participants must be
/// declared before they are used. Returns the messages and notes without their times.
inline std::vector<std::string> read_diagram(const std::string & path)
{
  static const std::string name = "([A-Za-z][A-Za-z0-9 .]*)";
  static const std::string text = R"(: \[\d+\.\d{3}\] ((?:[ -"&-:=?-~]|#\d+;)*))";
  static const std::regex declaration("participant " + name);
  static const std::regex message(name + "(->>|-->>|-x|--x)" + name + text);
  static const std::regex note("(Note over )" + name + "(,)?" + "(?:" + name + ")?" + text);
  static const std::regex comment("%% [ -~]*");
  std::ifstream file(path);
  std::set<std::string> participants{""};
  std::vector<std::string> lines;
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "sequenceDiagram");
  while (std::getline(file, line)) {
    std::smatch match;
    if (std::regex_match(line, match, declaration)) {
      EXPECT_TRUE(participants.insert(match[1]).second) << line;
    } else if (std::regex_match(line, match, message)) {
      EXPECT_TRUE(participants.contains(match[1]) && participants.contains(match[3])) << line;
      lines.push_back(match[1].str() + match[2].str() + match[3].str() + ": " + match[4].str());
    } else if (std::regex_match(line, match, note)) {
      EXPECT_TRUE(participants.contains(match[2]) && participants.contains(match[4])) << line;
      lines.push_back("Note over " + match[2].str() + match[3].str() + match[4].str() + ": " +
                      match[5].str());
    } else {
      EXPECT_TRUE(std::regex_match(line, comment)) << "Mermaid does not read: " << line;
    }
  }
  return lines;
}

/// The lines of a diagram that contain the text, in order.
inline std::vector<std::string> lines_with(const std::vector<std::string> & lines, const std::string & text)
{
  std::vector<std::string> result;
  for (const std::string & line : lines) {
    if (line.find(text) != std::string::npos) {
      result.push_back(line);
    }
  }
  return result;
}

/// The messages and notes of a peer, shortened: "> text" from the peer, "< text" to it, "x> text" and "x<
/// text" for closed connections, "text" for notes.
inline std::vector<std::string> session_of(const std::vector<std::string> & lines, const std::string & peer)
{
  const std::vector<std::pair<std::string, std::string>> prefixes{{peer + "->>robot: ", "> "},
                                                                  {"robot-->>" + peer + ": ", "< "},
                                                                  {peer + "-xrobot: ", "x> "},
                                                                  {"robot--x" + peer + ": ", "x< "},
                                                                  {"Note over robot," + peer + ": ", ""}};
  std::vector<std::string> result;
  for (const std::string & line : lines) {
    for (const auto & [prefix, replacement] : prefixes) {
      if (line.starts_with(prefix)) {
        result.push_back(replacement + line.substr(prefix.size()));
      }
    }
  }
  return result;
}

}  // namespace ur_simulator::testing
