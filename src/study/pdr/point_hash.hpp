#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "driftmesh/point.hpp"

namespace driftmesh::pdr {

/// For tables of points by their exact coordinates. 0 and -0 are equal, so they hash alike.
struct PointHash {
  std::size_t operator()(const Point& p) const {
    const auto bits = [](double d) { return std::bit_cast<std::uint64_t>(d + 0.0); };
    std::uint64_t h = bits(p.x) * 0x9e3779b97f4a7c15U;
    h = (h ^ (h >> 29) ^ bits(p.y)) * 0xbf58476d1ce4e5b9U;
    return h ^ (h >> 32);
  }
};

}  // namespace driftmesh::pdr
