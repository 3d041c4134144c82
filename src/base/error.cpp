#include "driftmesh/error.hpp"

#include <cerrno>
#include <cstring>

namespace driftmesh {
namespace {

std::string format_place(const SourcePlace& place) {
  return place.line == 0 ? place.file : place.file + ":" + std::to_string(place.line);
}

std::string with_system_reason(const std::string& file, const std::string& what) {
  std::string message = file + ": " + what;
  if (errno != 0) message += std::string(": ") + std::strerror(errno);
  return message;
}

}  // namespace

InputError::InputError(const SourcePlace& place, const std::string& what, const std::string& next)
    : Error(format_place(place) + ": " + what + (next.empty() ? "" : "; " + next)) {}

FileError::FileError(const std::string& file, const std::string& what) : Error(with_system_reason(file, what)) {}

}  // namespace driftmesh
