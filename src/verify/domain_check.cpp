#include "verify/domain_check.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/arrangement.hpp"
#include "verify/extended.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

/// The boundary alone, its points renumbered.
Arrangement arrange_boundary(const Mesh& mesh, const std::vector<Mesh::Edge>& boundary) {
  std::unordered_map<std::int32_t, std::int32_t> number;
  std::vector<Point> points;
  std::vector<Arrangement::Link> links;
  const auto take = [&](std::int32_t v) {
    const auto [entry, added] = number.try_emplace(v, static_cast<std::int32_t>(points.size()));
    if (added) points.push_back(mesh.points[v]);
    return entry->second;
  };
  links.reserve(boundary.size());
  for (const auto& edge : boundary) {
    const std::int32_t a = take(edge.a), b = take(edge.b);
    links.push_back({a, b});
  }
  return Arrangement(std::move(points), std::move(links));
}

}  // namespace

void check_embedding(const NamedMesh& mesh, const std::vector<Mesh::Edge>& boundary, Findings& findings) {
  const Arrangement arrangement = arrange_boundary(mesh.mesh(), boundary);
  if (arrangement.conflict()) {
    findings.add(Flaw::kBoundaryCrosses, [&] { return "on the boundary " + *arrangement.conflict(); });
    return;
  }
  enum : char { kUnseen, kCovered, kBare };
  std::vector<char> state(arrangement.face_count(), kUnseen);
  state[Arrangement::kUnbounded] = kBare;
  const auto expect = [&](std::int32_t face, char expected, std::size_t edge) {
    char& known = state[face];
    if (known == kUnseen) known = expected;
    if (known != expected)
      findings.add(Flaw::kOverlap, [&] {
        return formatted("boundary {}: the {} side is {} by triangles, the rest of that face is {}",
                         edge_words(mesh, boundary[edge].a, boundary[edge].b), expected == kCovered ? "left" : "right",
                         expected == kCovered ? "covered" : "not covered",
                         expected == kCovered ? "outside or not covered" : "covered");
      });
  };
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    expect(arrangement.left_face(static_cast<std::int32_t>(i)), kCovered, i);
    expect(arrangement.right_face(static_cast<std::int32_t>(i)), kBare, i);
  }
}

std::vector<char> DomainCheck::find_corners(const Mesh& mesh, const Domain& domain, const PointIndex& mesh_points) {
  std::vector<char> corner(mesh.points.size());
  for (const Point& p : domain.points())
    if (const std::int32_t v = mesh_points.find(p); v != kNone) corner[v] = 1;
  return corner;
}

DomainCheck::DomainCheck(const NamedMesh& mesh, const Domain& domain, const PointIndex& mesh_points,
                         const Chains& chains, Findings& findings)
    : names_(mesh),
      mesh_(mesh.mesh()),
      domain_(domain),
      chains_(chains),
      findings_(findings),
      segment_of_chain_(chains.all().size(), kNone) {
  vertex_of_point_.reserve(domain.points().size());
  for (const Point& p : domain.points()) vertex_of_point_.push_back(mesh_points.find(p));
}

void DomainCheck::check_points() {
  for (std::size_t p = 0; p < vertex_of_point_.size(); ++p)
    if (domain_.point_inside(static_cast<std::int32_t>(p)) && vertex_of_point_[p] == kNone)
      findings_.add(Flaw::kPointMissing, [&] {
        return formatted("the input point {} lies in the domain and is not a vertex", place_words(domain_.points()[p]));
      });
}

std::string DomainCheck::chain_words(const Chains::Chain& chain) const {
  return formatted("the chain of {} subsegments from {} to {}", chain.subsegments.size(),
                   point_words(names_, chain.vertices.front()), point_words(names_, chain.vertices.back()));
}

void DomainCheck::check_chains() {
  const auto key = [](std::int32_t u, std::int32_t v) {
    return static_cast<std::uint64_t>(std::min(u, v)) << 32 | static_cast<std::uint64_t>(std::max(u, v));
  };
  std::unordered_map<std::uint64_t, std::int32_t> segment_between;  // vertices of the mesh
  const auto& segments = domain_.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::int32_t a = vertex_of_point_[segments[i].a], b = vertex_of_point_[segments[i].b];
    if (a != kNone && b != kNone) segment_between.emplace(key(a, b), static_cast<std::int32_t>(i));
  }
  std::vector<char> found(segments.size());
  for (std::size_t c = 0; c < chains_.all().size(); ++c) {
    const Chains::Chain& chain = chains_.all()[c];
    const auto entry = segment_between.find(key(chain.vertices.front(), chain.vertices.back()));
    if (entry == segment_between.end() || !domain_.inside(segments[entry->second]) || found[entry->second]) {
      findings_.add(Flaw::kUnknownSubsegment, [&] {
        return chain_words(chain) + (entry == segment_between.end() ? " joins points that no input segment joins"
                                     : found[entry->second]         ? " doubles another one"
                                                                    : " is an input segment outside the domain");
      });
      continue;
    }
    found[entry->second] = 1;
    segment_of_chain_[c] = entry->second;
    const Domain::Segment& segment = segments[entry->second];
    check_chain(chain, segment, vertex_of_point_[segment.a] != chain.vertices.front());
  }
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!found[i] && domain_.inside(segments[i]))
      findings_.add(Flaw::kSegmentMissing, [&] {
        return formatted("no chain of subsegments joins the ends {} and {} of an input segment",
                         place_words(domain_.points()[segments[i].a]), place_words(domain_.points()[segments[i].b]));
      });
}

void DomainCheck::check_chain(const Chains::Chain& chain, const Domain::Segment& segment, bool reversed) {
  check_straight(chain);
  const Subsegments& subsegments = chains_.subsegments();
  const std::int32_t left = reversed ? segment.right_face : segment.left_face;
  const std::int32_t right = reversed ? segment.left_face : segment.right_face;
  for (std::size_t i = 0; i < chain.subsegments.size(); ++i) {
    const std::int32_t s = chain.subsegments[i], from = chain.vertices[i];
    if (subsegments[s].marker != segment.marker)
      findings_.add(Flaw::kWrongMarker, [&] {
        return formatted("subsegment {}, {}, has marker {}, expected {}", s,
                         edge_words(names_, subsegments[s].a, subsegments[s].b), subsegments[s].marker, segment.marker);
      });
    check_side(s, subsegments.left(s, from), left);
    check_side(s, subsegments.right(s, from), right);
  }
}

void DomainCheck::check_side(std::int32_t subsegment, std::int32_t triangle, std::int32_t face) {
  const bool covered = triangle != kNone, expected = domain_.inside(face);
  if (covered == expected) return;
  const Mesh::Edge& edge = chains_.subsegments()[subsegment];
  if (expected)
    findings_.add(Flaw::kNotCovered, [&] {
      return edge_words(names_, edge.a, edge.b) + " has no triangle on one side although the domain lies there";
    });
  else
    findings_.add(face == Arrangement::kUnbounded ? Flaw::kOutsideFilled : Flaw::kHoleFilled, [&] {
      return triangle_words(names_, triangle) + " lies " +
             (face == Arrangement::kUnbounded ? "outside the domain" : "in a hole") + ", at " +
             edge_words(names_, edge.a, edge.b);
    });
}

void DomainCheck::check_straight(const Chains::Chain& chain) {
  const auto at = [&](std::size_t i) -> const Point& { return mesh_.points[chain.vertices[i]]; };
  const std::size_t last = chain.vertices.size() - 1;
  const Point &a = at(0), &b = at(last);
  const long double length = std::sqrt(dot_extended(a, b, b)), tolerance = Domain::split_tolerance(a, b);
  long double before = 0;
  for (std::size_t i = 1; i < last; ++i) {
    const long double off = std::fabs(cross_extended(a, b, at(i))) / length, along = dot_extended(a, b, at(i)) / length;
    if (off <= tolerance && along > before - tolerance && along < length + tolerance) {
      before = along;
      continue;
    }
    findings_.add(Flaw::kOffSegment, [&] {
      return formatted(
          "{} on {} is {:.3g} off its line (at most {:.3g}) and {:.17g} of {:.17g} along it, after {:.17g}",
          point_words(names_, chain.vertices[i]), chain_words(chain), static_cast<double>(off),
          static_cast<double>(tolerance), static_cast<double>(along), static_cast<double>(length),
          static_cast<double>(before));
    });
    before = along;
  }
}

void DomainCheck::check_area(double mesh_area) {
  if (std::fabs(mesh_area - domain_.area()) <= domain_.area_tolerance()) return;
  findings_.add(Flaw::kWrongArea, [&] {
    return formatted("the triangles cover {:.17g}, the domain has {:.17g} (rounding explains {:.3g})", mesh_area,
                     domain_.area(), domain_.area_tolerance());
  });
}

// From 3F = 2E - B and V - E + F = chi.
void DomainCheck::check_euler(std::int64_t triangles, std::int64_t used_points, std::int64_t boundary_edges) {
  const std::int64_t expected = 2 * used_points - boundary_edges - 2 * domain_.euler_number();
  if (triangles == expected) return;
  findings_.add(Flaw::kWrongEuler, [&] {
    return formatted("{} triangles; {} vertices, {} boundary edges and Euler number {} of the domain require {}",
                     triangles, used_points, boundary_edges, domain_.euler_number(), expected);
  });
}

/// Calls visit(triangle, face) for the triangles beside all chains of segments, and the faces that lie there.
template <class Visit>
void DomainCheck::for_each_side(const Visit& visit) const {
  const Subsegments& subsegments = chains_.subsegments();
  for (std::size_t c = 0; c < chains_.all().size(); ++c) {
    if (segment_of_chain_[c] == kNone) continue;
    const Chains::Chain& chain = chains_.all()[c];
    const Domain::Segment& segment = domain_.segments()[segment_of_chain_[c]];
    const bool reversed = vertex_of_point_[segment.a] != chain.vertices.front();
    for (std::size_t i = 0; i < chain.subsegments.size(); ++i) {
      const std::int32_t s = chain.subsegments[i], from = chain.vertices[i];
      const std::int32_t left = subsegments.left(s, from), right = subsegments.right(s, from);
      if (left != kNone) visit(left, reversed ? segment.right_face : segment.left_face);
      if (right != kNone) visit(right, reversed ? segment.left_face : segment.right_face);
    }
  }
}

std::vector<std::int32_t> DomainCheck::find_faces(DisjointSets<std::int32_t>& parts) const {
  std::vector<std::int32_t> face_of_part(mesh_.triangles.size(), kNone), faces;
  for_each_side([&](std::int32_t triangle, std::int32_t face) { face_of_part[parts.find(triangle)] = face; });
  faces.reserve(face_of_part.size());
  for (const std::int32_t t : first_ids<std::int32_t>(face_of_part.size()))
    faces.push_back(face_of_part[parts.find(t)]);
  return faces;
}

std::vector<std::optional<Point>> DomainCheck::find_places() const {
  std::vector<std::optional<Point>> places(domain_.face_count());
  std::vector<long double> best(places.size());
  for_each_side([&](std::int32_t triangle, std::int32_t face) {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Point &p = mesh_.points[a], &q = mesh_.points[b], &r = mesh_.points[c];
    const long double thick = thickness(triangle);
    const double rounding = Domain::split_tolerance(p, q) + Domain::split_tolerance(q, r);
    if (!(thick > 3 * rounding) || thick <= best[face]) return;
    best[face] = thick;
    places[face] = {p.x / 3 + q.x / 3 + r.x / 3, p.y / 3 + q.y / 3 + r.y / 3};
  });
  return places;
}

/// The least height of a triangle; not positive if it is not counterclockwise.
long double DomainCheck::thickness(std::int32_t triangle) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  const Point &p = mesh_.points[a], &q = mesh_.points[b], &r = mesh_.points[c];
  const long double longest = std::max({dot_extended(p, q, q), dot_extended(q, r, r), dot_extended(r, p, p)});
  return longest > 0 ? cross_extended(p, q, r) / std::sqrt(longest) : 0;
}

}  // namespace driftmesh
