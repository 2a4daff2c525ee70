#include "ur_ros_rtde_robot/connection/text.hpp"

#include <boost/locale/utf.hpp>

namespace ur_ros_rtde {

std::string printable(std::string_view text)
{
  namespace utf = boost::locale::utf;
  const auto fits = [](utf::code_point code) {
    return utf::is_valid_codepoint(code) && code != 0x7F && (code >= 0x20 || code == '\n' || code == '\t');
  };
  std::string result;
  result.reserve(text.size());
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = at;
    if (fits(utf::utf_traits<char>::decode(at, text.end()))) {
      result.append(begin, at);
    } else {
      at = begin + 1;
      result.push_back('?');
    }
  }
  return result;
}

}  // namespace ur_ros_rtde
