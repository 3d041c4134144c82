#include "base/xml_text.hpp"

#include <string_view>
#include <utility>

namespace driftmesh {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string unescaped(std::string text) {
  for (const auto& [code, character] :
       {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}})
    for (std::size_t found = 0; (found = text.find(code, found)) != std::string::npos; ++found)
      text.replace(found, std::string_view(code).size(), character);
  return text;
}

}  // namespace driftmesh
