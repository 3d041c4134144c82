#include "mesh/channel.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/feature_sizes.hpp"

namespace driftmesh {
namespace {

/// The first segment met around a vertex, and its other end.
struct Met {
  SubsegmentId segment = kNone;
  VertexId end = kNone;
};

/// From the apex of `base`, the first segment beyond its triangle, counterclockwise around the apex or clockwise.
Met segment_around_apex(const Triangulation& mesh, HalfEdge base, bool counterclockwise) {
  constexpr int kFarthest = 40;  // triangles: what is behind more of them is not near
  const VertexId apex = mesh.apex(base);
  TriangleId t = triangle_of(base);
  int i = index_of(base);
  for (int step = 0; step < kFarthest; ++step) {
    const HalfEdge out = mesh.twin(half_edge(t, counterclockwise ? next(i) : previous(i)));
    if (is_constrained(out))
      return {subsegment_of(out), mesh.triangles[t].vertex[counterclockwise ? previous(i) : next(i)]};
    t = triangle_of(out);
    const auto& v = mesh.triangles[t].vertex;
    i = v[0] == apex ? 0 : v[1] == apex ? 1 : 2;
  }
  return {};
}

std::int32_t shell_of(const Triangulation& mesh, SubsegmentId s) {
  return mesh.roots[mesh.subsegments[s].root].shell;
}

}  // namespace

Facing facing_segments(const Triangulation& mesh, HalfEdge base, double length) {
  constexpr double kSteepest = 0.7;  // sizes grow as fast without a segment
  const VertexId a = mesh.edge_start(base), b = mesh.edge_end(base), c = mesh.apex(base);
  const Point &pa = mesh.points[a], &pb = mesh.points[b];
  const double ux = (pb.x - pa.x) / length, uy = (pb.y - pa.y) / length;
  const auto along = [&](const Point& p) { return (p.x - pa.x) * ux + (p.y - pa.y) * uy; };
  const auto width = [&](const Point& p) { return (p.y - pa.y) * ux - (p.x - pa.x) * uy; };
  const std::int32_t shell = shell_of(mesh, subsegment_of(mesh.twin(base)));
  const double at_c = along(mesh.points[c]), width_c = width(mesh.points[c]);
  Facing facing;
  SubsegmentId first = kNone;
  for (const bool counterclockwise : {false, true}) {
    const auto [segment, d] = segment_around_apex(mesh, base, counterclockwise);
    if (segment == kNone || segment == first) continue;  // the second time around the free end of a segment
    first = segment;
    if (shell != kNone && shell_of(mesh, segment) == shell) facing.same_shell = true;
    if (d == a || d == b || is_shell_edge(mesh, a, c) || is_shell_edge(mesh, b, c)) continue;
    const double at_d = along(mesh.points[d]);
    const double rise = (width(mesh.points[d]) - width_c) / (at_d - at_c);
    if (!(std::fabs(rise) <= kSteepest)) continue;
    const Channel channel{std::max(0.0, std::min(at_c, at_d)), std::min(length, std::max(at_c, at_d)),
                          width_c - rise * at_c, rise};
    if (!(channel.from < channel.to && channel.least_width() > kResolution * length)) continue;
    facing.segments[facing.count] = segment;
    facing.channels[facing.count++] = channel;
  }
  return facing;
}

}  // namespace driftmesh
