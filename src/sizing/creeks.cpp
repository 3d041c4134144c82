#include "sizing/creeks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "base/disjoint_sets.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// Between pieces that do not cross.
double squared_distance_between(const AxisPiece& s, const AxisPiece& t) {
  return std::min({squared_distance_to_segment(s.a, t.a, t.b), squared_distance_to_segment(s.b, t.a, t.b),
                   squared_distance_to_segment(t.a, s.a, s.b), squared_distance_to_segment(t.b, s.a, s.b)});
}

}  // namespace

std::vector<Creek> find_creeks(OutlineSegments outline, double width) {
  sort_segments(outline);
  std::vector<AxisPiece> pieces = medial_axis(outline);
  std::erase_if(pieces, [&](const AxisPiece& piece) { return 2 * piece.radius >= width; });
  std::vector<Box> boxes;
  for (const AxisPiece& piece : pieces) boxes.push_back(Box::around(piece.a, piece.b, piece.radius / 2));
  // Pieces of one creek follow each other closer than its banks.
  DisjointSets<std::int32_t> creeks(pieces.size());
  BoxTree(boxes).visit_overlapping([&](std::int32_t i, std::int32_t j) {
    const AxisPiece &s = pieces[to_index(i)], &t = pieces[to_index(j)];
    const double reach = std::min(s.radius, t.radius);
    if (squared_distance_between(s, t) <= reach * reach) creeks.join(i, j);
  });
  std::map<std::int32_t, Creek> found;
  for (const std::int32_t i : first_ids<std::int32_t>(pieces.size())) {
    const AxisPiece& piece = pieces[to_index(i)];
    Creek& creek = found[creeks.find(i)];
    creek.length += std::sqrt(squared_distance(piece.a, piece.b));
    if (creek.width != 0 && creek.width <= 2 * piece.radius) continue;
    creek.at = midpoint(piece.a, piece.b);
    creek.width = 2 * piece.radius;
  }
  std::vector<Creek> narrow;
  for (const auto& [piece, creek] : found) narrow.push_back(creek);
  std::ranges::sort(narrow, {}, [](const Creek& c) { return std::tuple(c.width, c.at.x, c.at.y); });
  return narrow;
}

}  // namespace driftmesh
