#include "mesh/corners.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "geometry/triangle_geometry.hpp"
#include "mesh/cavity.hpp"

namespace driftmesh {
namespace {

constexpr auto id = &Triangulation::id;
constexpr double kFarAway = std::numeric_limits<double>::infinity();

/// One end of a root segment that is still whole: 2 * root + (0: start, 1: end).
using SegmentEnd = std::int32_t;

RootId root_of(SegmentEnd e) {
  return e / 2;
}

struct SegmentEnds {
  const Triangulation& mesh;
  [[nodiscard]] VertexId apex(SegmentEnd e) const { return mesh.roots[id(root_of(e))].vertex[id(e % 2)]; }
  [[nodiscard]] VertexId other(SegmentEnd e) const { return mesh.roots[id(root_of(e))].vertex[id(1 - e % 2)]; }
};

/// The segment end that follows `e` counterclockwise around its apex inside the domain, or kNone if e's left is
/// outside.
SegmentEnd next_around_apex(const Triangulation& mesh, SegmentEnd e) {
  const Subsegment& s = mesh.subsegments[id(mesh.roots[id(root_of(e))].tree)];
  HalfEdge h = s.half[id(e % 2)];  // the edge that leaves the apex, with the domain on its left
  if (h == kNone) return kNone;
  for (;;) {
    h = mesh.twin(half_edge(triangle_of(h), next(next(index_of(h)))));  // the triangle's edge into the apex
    if (is_constrained(h)) break;
  }
  const Subsegment& last = mesh.subsegments[id(subsegment_of(h))];
  const VertexId apex = SegmentEnds{mesh}.apex(e);
  return 2 * last.root + (last.vertex[0] == apex ? 0 : 1);
}

/// Radians; 2 pi stands for all sectors that open by 180 degrees or more.
double sector_angle(const Triangulation& mesh, SegmentEnd e, SegmentEnd f) {
  const SegmentEnds ends{mesh};
  const Point& apex = mesh.points[id(ends.apex(e))];
  const Point& p = mesh.points[id(ends.other(e))];
  const Point& q = mesh.points[id(ends.other(f))];
  if (!(orient2d(apex, p, q) > 0)) return 2 * std::numbers::pi;
  return angle_at(p, apex, q);
}

/// Segment ends joined by acute angles, as sets with a representative each.
class Clusters {
 public:
  explicit Clusters(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  SegmentEnd find(SegmentEnd e) {
    while (parent_[id(e)] != e) e = parent_[id(e)] = parent_[id(parent_[id(e)])];
    return e;
  }
  void join(SegmentEnd e, SegmentEnd f) { parent_[id(find(e))] = find(f); }

 private:
  std::vector<SegmentEnd> parent_;
};

struct Cluster {
  std::vector<SegmentEnd> ends;
  bool sharp = false;
};

std::vector<Cluster> find_clusters(const Triangulation& mesh) {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto n = 2 * mesh.roots.size();
  Clusters joined(n);
  std::vector<double> smallest(n, 2 * std::numbers::pi);  // sector on either side of each end
  for (std::size_t i = 0; i < n; ++i) {
    const auto e = static_cast<SegmentEnd>(i);
    const SegmentEnd f = next_around_apex(mesh, e);
    if (f == kNone || f == e) continue;
    const double angle = sector_angle(mesh, e, f);
    if (angle >= 60 * kDegree * (1 - 1e-12)) continue;
    joined.join(e, f);
    smallest[id(e)] = std::min(smallest[id(e)], angle);
    smallest[id(f)] = std::min(smallest[id(f)], angle);
  }
  std::vector<Cluster> clusters(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (smallest[i] > std::numbers::pi) continue;
    Cluster& cluster = clusters[id(joined.find(static_cast<SegmentEnd>(i)))];
    cluster.ends.push_back(static_cast<SegmentEnd>(i));
    cluster.sharp |= smallest[i] < 20 * kDegree;
  }
  std::erase_if(clusters, [](const Cluster& c) { return c.ends.empty(); });
  return clusters;
}

double length(const Triangulation& mesh, RootId root) {
  const auto& v = mesh.roots[id(root)].vertex;
  return std::sqrt(squared_distance(mesh.points[id(v[0])], mesh.points[id(v[1])]));
}

double shell_radius(const Triangulation& mesh, const Cluster& cluster) {
  double shortest = kFarAway;
  for (const SegmentEnd e : cluster.ends) shortest = std::min(shortest, length(mesh, root_of(e)));
  return std::exp2(std::floor(std::log2(shortest / 3)));
}

/// A place where a segment is to be cut. Its shell piece reaches from there towards the apex.
struct Cut {
  SegmentEnd end;
  Point at;
  std::int32_t shell;      // shared by all pieces between the same two circles
  std::int32_t shell_end;  // shared by the points of one circle of a sharp cluster, else the point's own
};

/// All cuts, nearest to their apex first, from the segments as given. Radii come from the given lengths alone.
std::vector<Cut> plan_cuts(const Triangulation& mesh, const std::vector<Cluster>& clusters) {
  std::vector<bool> clustered(2 * mesh.roots.size(), false);
  for (const Cluster& cluster : clusters)
    for (const SegmentEnd e : cluster.ends) clustered[id(e)] = true;
  std::vector<Cut> cuts;
  std::int32_t names = 0;
  for (const Cluster& cluster : clusters) {
    double radius = shell_radius(mesh, cluster);
    for (bool first = true, any = true; first || (cluster.sharp && any); first = false, radius *= 2) {
      any = false;
      const std::int32_t shell = names++;
      for (const SegmentEnd e : cluster.ends) {
        const double whole = length(mesh, root_of(e));
        const bool other_end_too = clustered[id(e ^ 1)];
        if (radius > whole * (other_end_too ? 1.0 / 3 : 2.0 / 3)) continue;
        any = true;
        const Point& a = mesh.points[id(SegmentEnds{mesh}.apex(e))];
        const Point& b = mesh.points[id(SegmentEnds{mesh}.other(e))];
        const double share = radius / whole;
        cuts.push_back({e,
                        {snap_to_zero(a.x + share * (b.x - a.x)), snap_to_zero(a.y + share * (b.y - a.y))},
                        shell,
                        cluster.sharp ? shell : names++});
      }
    }
  }
  return cuts;
}

/// Cuts what is left of a root segment, which begins at `from` on the apex's side: the piece up to the cut becomes a
/// new root, the root keeps the rest. Returns the new vertex, kNone if rounding leaves no room.
VertexId cut_shell_piece(Triangulation& mesh, Cavity& cavity, VertexId from, const Cut& cut) {
  const RootId root = root_of(cut.end);
  const SubsegmentId rest = mesh.roots[id(root)].tree;
  if (cavity.gather_on(rest, cut.at) != Cavity::Found::kClear) return kNone;
  const VertexId v = mesh.add_vertex(cut.at, kShellEnd + cut.shell_end);
  const RootId shell = mesh.add_root(from, v, mesh.roots[id(root)].marker, cut.shell);
  const SubsegmentId piece = mesh.roots[id(shell)].tree;
  Subsegment& s = mesh.subsegments[id(rest)];
  const bool at_start = s.vertex[0] == from;
  s.vertex[at_start ? 0 : 1] = v;
  mesh.roots[id(root)].vertex = s.vertex;
  cavity.fill_on(v, at_start ? piece : rest, at_start ? rest : piece);
  return v;
}

}  // namespace

std::int32_t prepare_corners(Triangulation& mesh) {
  const std::vector<Cluster> clusters = find_clusters(mesh);
  const std::vector<Cut> cuts = plan_cuts(mesh, clusters);
  Cavity cavity(mesh);
  std::vector<VertexId> reached(2 * mesh.roots.size(), kNone);  // last cut from each end
  for (const Cut& cut : cuts) {
    VertexId& from = reached[id(cut.end)];
    if (from == kNone) from = SegmentEnds{mesh}.apex(cut.end);
    if (const VertexId v = cut_shell_piece(mesh, cavity, from, cut); v != kNone) from = v;
  }
  return static_cast<std::int32_t>(clusters.size());
}

bool on_same_shell(const Triangulation& mesh, VertexId u, VertexId v) {
  const VertexOrigin a = mesh.origin[id(u)], b = mesh.origin[id(v)];
  if (is_shell_end(a) && a == b) return true;
  if (!is_midpoint(a) || !is_midpoint(b)) return false;
  const Subsegment& s = mesh.subsegments[id(~a)];
  const Subsegment& t = mesh.subsegments[id(~b)];
  return s.path == t.path && s.root != t.root && mesh.roots[id(s.root)].shell != kNone &&
         mesh.roots[id(s.root)].shell == mesh.roots[id(t.root)].shell;
}

}  // namespace driftmesh
