#include "verify/local_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "verify/point_index.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

void check_length(std::size_t actual, std::size_t expected, const char* array, Findings& findings) {
  if (actual != expected)
    findings.add(Flaw::bad_array,
                 [&] { return fmt::format("{} has {} entries, expected {}", array, actual, expected); });
}

}  // namespace

bool check_arrays(const Mesh& mesh, Findings& findings) {
  const std::size_t n = mesh.points.size();
  if (!mesh.point_markers.empty()) check_length(mesh.point_markers.size(), n, "the array of point markers", findings);
  if (!mesh.regions.empty()) check_length(mesh.regions.size(), mesh.triangles.size(), "the array of regions", findings);
  if (!mesh.subdomains.empty())
    check_length(mesh.subdomains.size(), mesh.triangles.size(), "the array of subdomains", findings);
  if (!mesh.ranks.empty()) check_length(mesh.ranks.size(), mesh.triangles.size(), "the array of ranks", findings);
  check_length(mesh.attributes.size(), n * std::max(0, mesh.attributes_per_point), "the array of point attributes",
               findings);
  const auto valid = [&](std::int32_t i) { return to_index(i) < n; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (!valid(a) || !valid(b) || !valid(c) || a == b || b == c || c == a)
      findings.add(Flaw::bad_index, [&] {
        return triangle_words(mesh, t) + fmt::format(": three different points below {} are expected", n);
      });
  }
  for (std::size_t s = 0; s < mesh.edges.size(); ++s) {
    const auto& [a, b, marker] = mesh.edges[s];
    if (!valid(a) || !valid(b) || a == b)
      findings.add(Flaw::bad_index, [&, u = a, v = b] {
        return fmt::format("subsegment {} ({} {}): two different points below {} are expected", s, u, v, n);
      });
  }
  return findings.empty();
}

std::size_t check_points(const Mesh& mesh, const CornerTable& corners, PointIndex& index, Findings& findings) {
  std::size_t used = 0;
  for (const std::int32_t i : first_ids<std::int32_t>(mesh.points.size())) {
    if (!corners.used(i)) continue;
    ++used;
    const Point& p = mesh.points[i];
    if (!in_coordinate_range(p.x) || !in_coordinate_range(p.y)) {
      findings.add(Flaw::bad_coordinate, [&] { return point_words(mesh, i) + " is outside the range of coordinates"; });
      continue;
    }
    if (const std::int32_t first = index.add(i); first != i)
      findings.add(Flaw::duplicate_point,
                   [&] { return point_words(mesh, i) + fmt::format(" has the coordinates of point {}", first); });
  }
  return used;
}

std::vector<Mesh::Edge> boundary_edges(const Mesh& mesh, const CornerTable& corners) {
  std::vector<Mesh::Edge> edges;
  Fan fan;
  for (const std::int32_t hub : first_ids<std::int32_t>(mesh.points.size())) {
    fan.gather(mesh, corners.around(hub));
    for (std::size_t i = 0; i < fan.spokes().size(); ++i)
      if (fan.across_next(i) == kNone) edges.push_back({hub, fan.spokes()[i].next, 0});
  }
  return edges;
}

void check_subsegments(const Mesh& mesh, const Subsegments& subsegments, Findings& findings) {
  for (const std::int32_t s : subsegments.ids()) {
    const auto& [a, b, marker] = subsegments[s];
    const auto say = [&, u = a, v = b](const char* what) {
      return [&, u, v, what] { return fmt::format("subsegment {}, {}, {}", s, edge_words(mesh, u, v), what); };
    };
    if (subsegments.find(a, b) != s)
      findings.add(Flaw::duplicate_subsegment, say("is listed before"));
    else if (subsegments.left(s, a) == kNone && subsegments.right(s, a) == kNone)
      findings.add(Flaw::stray_subsegment, say("is an edge of no triangle"));
  }
}

void LocalCheck::check_orientations(std::size_t begin, std::size_t end) {
  for (std::size_t t = begin; t < end; ++t) {
    const auto& [a, b, c] = mesh_.triangles[t];
    const double orientation = orient2d(at(a), at(b), at(c));
    if (!(orientation > 0))
      findings_.add(Flaw::not_counterclockwise, [&] {
        return triangle_words(mesh_, t) +
               fmt::format(" is {}: orientation {}, expected > 0", orientation < 0 ? "inverted" : "flat", orientation);
      });
  }
}

void LocalCheck::check_vertices(std::size_t begin, std::size_t end, DisjointSets<std::int32_t>* parts, bool delaunay) {
  parts_ = parts;
  delaunay_ = delaunay;
  for (std::size_t hub = begin; hub < end; ++hub) check_vertex(static_cast<std::int32_t>(hub));
}

void LocalCheck::append(const LocalCheck& later) {
  findings_.append(later.findings_);
  boundary_.insert(boundary_.end(), later.boundary_.begin(), later.boundary_.end());
  interfaces_.edges += later.interfaces_.edges;
  interfaces_.not_delaunay += later.interfaces_.not_delaunay;
  interfaces_.between_ranks += later.interfaces_.between_ranks;
  interfaces_.subdomains.insert(later.interfaces_.subdomains.begin(), later.interfaces_.subdomains.end());
}

void LocalCheck::check_vertex(std::int32_t hub) {
  fan_.gather(mesh_, corners_.around(hub));
  check_sides(hub);
  const auto spokes = fan_.spokes();
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    const std::int32_t right = fan_.across_next(i);
    if (right == kNone) boundary_.push_back({hub, spokes[i].next, 0});
    // Each edge is checked from its lower end.
    if (hub < spokes[i].next) check_edge(hub, spokes[i].next, &spokes[i], right == kNone ? nullptr : &spokes[right]);
    if (hub < spokes[i].prev && fan_.across_prev(i) == kNone) check_edge(hub, spokes[i].prev, nullptr, &spokes[i]);
  }
  const Fan::Shape shape = fan_.shape();
  if (shape.rings > (shape.sectors == 0 ? 1 : 0))
    findings_.add(Flaw::tangled_vertex, [&] {
      return point_words(mesh_, hub) + fmt::format(
                                           ": its triangles form {} closed rings and {} open sectors, expected "
                                           "one ring or only sectors",
                                           shape.rings, shape.sectors);
    });
}

// Directed edges that leave the hub are equal `next` entries, neighbors in the sorted fan.
void LocalCheck::check_sides(std::int32_t hub) {
  const auto spokes = fan_.spokes();
  for (std::size_t i = 1; i < spokes.size(); ++i) {
    const Spoke &a = spokes[i - 1], &b = spokes[i];
    if (a.next != b.next) continue;
    if (a.prev == b.prev) {
      if (hub < a.next && hub < a.prev)
        findings_.add(Flaw::duplicate_triangle, [&] {
          return triangle_words(mesh_, a.triangle) + " and " + triangle_words(mesh_, b.triangle) +
                 " have the same corners";
        });
    } else {
      findings_.add(Flaw::edge_used_twice, [&] {
        return triangle_words(mesh_, a.triangle) + " and " + triangle_words(mesh_, b.triangle) +
               " lie on the same side of " + edge_words(mesh_, hub, a.next);
      });
    }
  }
}

void LocalCheck::check_edge(std::int32_t u, std::int32_t v, const Spoke* left, const Spoke* right) {
  const std::int32_t s = subsegments_.find(u, v);
  if (s != kNone) {
    subsegments_.set_sides(s, u, left != nullptr ? left->triangle : kNone, right != nullptr ? right->triangle : kNone);
  } else if (left == nullptr || right == nullptr) {
    findings_.add(Flaw::open_edge, [&] {
      return edge_words(mesh_, u, v) + " has one triangle, " +
             triangle_words(mesh_, (left != nullptr ? left : right)->triangle) +
             ", but is not a subsegment: two triangles are expected";
    });
  } else {
    if (is_interface(*left, *right))
      note_interface(u, v, *left, *right);
    else if (delaunay_)
      check_delaunay(u, v, *left, *right);
    if (parts_ != nullptr) parts_->join(left->triangle, right->triangle);
  }
}

void LocalCheck::note_interface(std::int32_t u, std::int32_t v, const Spoke& left, const Spoke& right) {
  const std::int32_t one = left.triangle, other = right.triangle;
  ++interfaces_.edges;
  interfaces_.not_delaunay += is_delaunay(u, v, left, right) ? 0 : 1;
  if (!mesh_.ranks.empty()) interfaces_.between_ranks += mesh_.ranks[one] != mesh_.ranks[other] ? 1 : 0;
  const auto [low, high] = std::minmax(mesh_.subdomains[one], mesh_.subdomains[other]);
  interfaces_.subdomains.emplace(low, high);
}

// The circumcircle test says nothing about an inverted triangle, which is a flaw of its own.
bool LocalCheck::is_delaunay(std::int32_t u, std::int32_t v, const Spoke& left, const Spoke& right) const {
  const Point &p = at(left.prev), &q = at(right.next);
  return !(incircle(at(u), at(v), p, q) > 0) || !(orient2d(at(u), at(v), p) > 0) || !(orient2d(at(v), at(u), q) > 0);
}

void LocalCheck::check_delaunay(std::int32_t u, std::int32_t v, const Spoke& left, const Spoke& right) {
  if (is_delaunay(u, v, left, right)) return;
  const double inside = incircle(at(u), at(v), at(left.prev), at(right.next));
  findings_.add(Flaw::not_delaunay, [&] {
    return edge_words(mesh_, u, v) +
           fmt::format(" between {} and {}: ", triangle_words(mesh_, left.triangle),
                       triangle_words(mesh_, right.triangle)) +
           fmt::format("{} lies inside the circumcircle of the first (incircle {}, expected <= 0)",
                       point_words(mesh_, right.next), inside);
  });
}

}  // namespace driftmesh
