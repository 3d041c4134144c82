#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "verify/arrangement.hpp"

namespace driftmesh {

/// Which faces of an arrangement polygons cover, by the meaning that Pslg gives to them. The way from face to face over
/// a link changes sides of every ring that walks the link an odd number of times; nothing else is computed.
class FaceCover {
 public:
  /// Corners of the rings are points of the arrangement; those that follow each other differ, and a link joins them.
  FaceCover(const Arrangement& arrangement, std::span<const Pslg::Polygon> polygons);

  [[nodiscard]] bool covered(std::int32_t face) const { return covered_[face] != 0; }
  /// That of the last polygon which covers the face and has one, or -1.
  [[nodiscard]] std::int32_t region(std::int32_t face) const { return region_[face]; }

 private:
  std::vector<char> covered_;
  std::vector<std::int32_t> region_;
};

}  // namespace driftmesh
