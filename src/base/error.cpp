#include "driftmesh/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace driftmesh {
namespace {

std::string format_place(const SourcePlace& place) {
  return place.line == 0 ? place.file : place.file + ":" + std::to_string(place.line);
}

/// What a damaged file holds must neither control a terminal nor fill it.
std::string for_terminal(std::string text) {
  constexpr std::size_t kMostBytes = 1000;
  if (text.size() > kMostBytes) text.replace(kMostBytes, std::string::npos, "...");
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return (c < ' ' && c != '\n') || c == 0x7f; }, '?');
  return text;
}

std::string with_system_reason(const std::string& file, const std::string& what) {
  std::string message = file + ": " + what;
  if (errno != 0) message += std::string(": ") + std::strerror(errno);
  return message;
}

}  // namespace

InputError::InputError(const SourcePlace& place, const std::string& what, const std::string& next)
    : Error(format_place(place) + ": " + for_terminal(what) + (next.empty() ? "" : "; " + next)), place_(place) {}

FileError::FileError(const std::string& file, const std::string& what)
    : Error(with_system_reason(file, what)), file_(file) {}

}  // namespace driftmesh
