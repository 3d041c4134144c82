#pragma once

#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "mesh/carve.hpp"
#include "patch/new_outline.hpp"
#include "patch/old_places.hpp"
#include "patch/part.hpp"

namespace driftmesh::patch {

/// What is to be triangulated anew.
struct Domain {
  Pslg pslg;  ///< without polygons, holes and places of regions; its markers of points are those of new ones
  std::vector<SegmentSides> sides;  ///< one for each of its segments
  std::vector<bool> fixed;          ///< segments that nothing may split: beyond them everything stays
  std::vector<bool> free;           ///< points that refinement may delete
};

/// What of a part is triangulated anew, and how far.
struct Extent {
  std::vector<bool> taken;   ///< triangles that may change
  std::vector<bool> inside;  ///< those of them that are to be made anew
  std::vector<bool> held;    ///< points that stay whatever is around them

  // Only with a new outline:
  std::vector<bool> gone;     ///< edges that are on it no longer
  std::vector<bool> dropped;  ///< points that do not stay, whatever their markers
  std::vector<Piece> pieces;  ///< what it has in place of the edges
};

/// The triangles that are taken, as a domain. Chains of segments in line become one, and free points disappear, where
/// all triangles around them are inside. With a new outline, what is taken is exchanged for what it bounds there;
/// throws Error where its tolerance has put a line on another one.
[[nodiscard]] Domain domain_of(const Part& part, const Extent& extent, const OldPlaces& old);

}  // namespace driftmesh::patch
