#pragma once

#include <sstream>
#include <string>

namespace driftmesh::oracles {

/// The parts as one text, numbers with all their digits.
template <class... Parts>
std::string words(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

}  // namespace driftmesh::oracles
