#include "verify/local_check.hpp"

#include <algorithm>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

void check_length(std::size_t actual, std::size_t expected, const char* array, Findings& findings) {
  if (actual != expected)
    findings.add(Flaw::kBadArray, [&] { return formatted("{} has {} entries, expected {}", array, actual, expected); });
}

}  // namespace

bool check_arrays(const NamedMesh& names, Findings& findings) {
  const Mesh& mesh = names.mesh();
  const std::size_t n = mesh.points.size();
  if (!mesh.point_markers.empty()) check_length(mesh.point_markers.size(), n, "the array of point markers", findings);
  if (!mesh.regions.empty()) check_length(mesh.regions.size(), mesh.triangles.size(), "the array of regions", findings);
  if (!mesh.subdomains.empty())
    check_length(mesh.subdomains.size(), mesh.triangles.size(), "the array of subdomains", findings);
  if (!mesh.ranks.empty()) check_length(mesh.ranks.size(), mesh.triangles.size(), "the array of ranks", findings);
  if (mesh.attributes_per_point < 0)
    findings.add(Flaw::kBadArray, [&] {
      return formatted("points have {} attributes, expected at least 0", mesh.attributes_per_point);
    });
  check_length(mesh.attributes.size(), n * std::max(0, mesh.attributes_per_point), "the array of point attributes",
               findings);
  const auto valid = [&](std::int32_t i) { return to_index(i) < n; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (!valid(a) || !valid(b) || !valid(c) || a == b || b == c || c == a)
      findings.add(Flaw::kBadIndex, [&] {
        return triangle_words(names, t) + formatted(": three different points below {} are expected", n);
      });
  }
  for (std::size_t s = 0; s < mesh.edges.size(); ++s) {
    const auto& [a, b, marker] = mesh.edges[s];
    if (!valid(a) || !valid(b) || a == b)
      findings.add(Flaw::kBadIndex, [&, u = a, v = b] {
        return formatted("subsegment {} ({} {}): two different points below {} are expected", s, u, v, n);
      });
  }
  return findings.empty();
}

std::size_t check_coordinates(const NamedMesh& names, const CornerTable& corners, Findings& findings) {
  const Mesh& mesh = names.mesh();
  std::size_t used = 0;
  for (const std::int32_t i : first_ids<std::int32_t>(mesh.points.size())) {
    if (!corners.used(i)) continue;
    ++used;
    const Point& p = mesh.points[i];
    if (!in_coordinate_range(p.x) || !in_coordinate_range(p.y))
      findings.add(Flaw::kBadCoordinate,
                   [&] { return point_words(names, i) + " is outside the range of coordinates"; });
  }
  return used;
}

std::vector<Mesh::Edge> boundary_edges(const Mesh& mesh, const CornerTable& corners,
                                       std::span<const std::int32_t> hubs) {
  std::vector<Mesh::Edge> edges;
  Fan fan;
  for (const std::int32_t hub : hubs) {
    fan.gather(mesh, corners.around(hub));
    for (std::size_t i = 0; i < fan.spokes().size(); ++i)
      if (fan.across_next(i) == kNone) edges.push_back({hub, fan.spokes()[i].next, 0});
  }
  return edges;
}

void check_subsegments(const NamedMesh& mesh, const Subsegments& subsegments, Findings& findings) {
  for (const std::int32_t s : subsegments.ids()) {
    const auto& [a, b, marker] = subsegments[s];
    const auto say = [&, u = a, v = b](const char* what) {
      return [&, u, v, what] { return formatted("subsegment {}, {}, {}", s, edge_words(mesh, u, v), what); };
    };
    if (subsegments.find(a, b) != s)
      findings.add(Flaw::kDuplicateSubsegment, say("is listed before"));
    else if (subsegments.left(s, a) == kNone && subsegments.right(s, a) == kNone)
      findings.add(Flaw::kStraySubsegment, say("is an edge of no triangle"));
  }
}

void check_orientations(const NamedMesh& names, std::size_t begin, std::size_t end, Findings& findings) {
  const Mesh& mesh = names.mesh();
  for (std::size_t t = begin; t < end; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double orientation = orient2d(mesh.points[a], mesh.points[b], mesh.points[c]);
    if (!(orientation > 0))
      findings.add(Flaw::kNotCounterclockwise, [&] {
        return triangle_words(names, t) +
               formatted(" is {}: orientation {}, expected > 0", orientation < 0 ? "inverted" : "flat", orientation);
      });
  }
}

void FanCheck::check(std::span<const std::int32_t> hubs, DisjointSets<std::int32_t>* parts) {
  parts_ = parts;
  for (const std::int32_t hub : hubs) check_hub(hub);
}

void FanCheck::check_hub(std::int32_t hub) {
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
    findings_.add(Flaw::kTangledVertex, [&] {
      return point_words(names_, hub) + formatted(
                                            ": its triangles form {} closed rings and {} open sectors, expected "
                                            "one ring or only sectors",
                                            shape.rings, shape.sectors);
    });
}

// Directed edges that leave the hub are equal `next` entries, neighbors in the sorted fan.
void FanCheck::check_sides(std::int32_t hub) {
  const auto spokes = fan_.spokes();
  for (std::size_t i = 1; i < spokes.size(); ++i) {
    const Spoke &a = spokes[i - 1], &b = spokes[i];
    if (a.next != b.next) continue;
    if (a.prev == b.prev) {
      if (hub < a.next && hub < a.prev)
        findings_.add(Flaw::kDuplicateTriangle, [&] {
          return triangle_words(names_, a.triangle) + " and " + triangle_words(names_, b.triangle) +
                 " have the same corners";
        });
    } else {
      findings_.add(Flaw::kEdgeUsedTwice, [&] {
        return triangle_words(names_, a.triangle) + " and " + triangle_words(names_, b.triangle) +
               " lie on the same side of " + edge_words(names_, hub, a.next);
      });
    }
  }
}

void FanCheck::check_edge(std::int32_t u, std::int32_t v, const Spoke* left, const Spoke* right) {
  const std::int32_t s = subsegments_.find(u, v);
  if (s != kNone) {
    subsegments_.set_sides(s, u, left != nullptr ? left->triangle : kNone, right != nullptr ? right->triangle : kNone);
  } else if (left == nullptr || right == nullptr) {
    findings_.add(Flaw::kOpenEdge, [&] {
      return edge_words(names_, u, v) + " has one triangle, " +
             triangle_words(names_, (left != nullptr ? left : right)->triangle) +
             ", but is not a subsegment: two triangles are expected";
    });
  } else {
    edges_.check(u, v, {left->triangle, left->prev}, {right->triangle, right->next});
    if (parts_ != nullptr) parts_->join(left->triangle, right->triangle);
  }
}

}  // namespace driftmesh
