#include "mesh/step_inspection.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

StepCause cause_of_step(const Triangulation& mesh, TriangleId t) {
  const Triangle& triangle = mesh.triangles[t];
  std::array<double, 3> squared{};
  for (const int i : {0, 1, 2}) squared[i] = squared_distance(mesh.corner(t, next(i)), mesh.corner(t, previous(i)));
  const auto shortest = static_cast<int>(std::ranges::min_element(squared) - squared.begin());
  const HalfEdge across = triangle.neighbor[shortest];
  if (is_constrained(across))
    return mesh.subsegments[subsegment_of(across)].path == dyadic::kWhole ? StepCause::kSegment : StepCause::kHalf;
  const auto on_segment = [&](int i) { return mesh.origin[triangle.vertex[i]] != kFree; };
  return on_segment(next(shortest)) && on_segment(previous(shortest)) ? StepCause::kBetween : StepCause::kAngles;
}

}  // namespace

StepInspection inspect_step(const Triangulation& mesh, const TimeStep& step) {
  StepInspection found{std::numeric_limits<double>::infinity(), {}};
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    const CornerPoints corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const double room = step.room(corners);
    found.least_room = std::min(found.least_room, room);
    if (room < 1) found.misses.push_back({t, cause_of_step(mesh, t), room, step.needed(corners)});
  }
  return found;
}

}  // namespace driftmesh
