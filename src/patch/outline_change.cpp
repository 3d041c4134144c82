#include "patch/outline_change.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "adapt/locator.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/settle_points.hpp"

namespace driftmesh::patch {
namespace {

/// Whether a piece and a triangle, counterclockwise, have a point in common.
bool touch(const Piece& piece, const CornerPoints& t) {
  const auto& [p, q] = piece.end;
  for (std::size_t i = 0; i < 3; ++i)
    if (orient2d(t[i], t[(i + 1) % 3], p) < 0 && orient2d(t[i], t[(i + 1) % 3], q) < 0) return false;
  const std::array<double, 3> side{orient2d(p, q, t[0]), orient2d(p, q, t[1]), orient2d(p, q, t[2])};
  const auto [least, most] = std::ranges::minmax(side);
  return least <= 0 && most >= 0;
}

void list_borders(Mesh& mesh, const TriangleNeighbors& beyond) {
  const ConstrainedEdgeIndex index(mesh);
  std::vector<Mesh::Edge> more;
  for (std::size_t t = 0; t < beyond.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t other = beyond[t][i];
      const bool border = other < 0 || (std::cmp_less(t, other) && !mesh.regions.empty() &&
                                        mesh.regions[t] != mesh.regions[to_index(other)]);
      const std::int32_t a = mesh.triangles[t][(i + 1) % 3], b = mesh.triangles[t][(i + 2) % 3];
      if (border && index.find(a, b) < 0) more.push_back({a, b, 0});
    }
  mesh.edges.insert(mesh.edges.end(), more.begin(), more.end());
}

/// Points of the new domain move to those of the outline that are that near.
void settle(NewDomain& domain, const Mesh& mesh) {
  const ConstrainedEdgeIndex index(mesh);
  std::vector<Point> places;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (index.touches(static_cast<std::int32_t>(v))) places.push_back(mesh.points[v]);
  const std::vector<Point> before = domain.pslg.points;
  settle_points(domain.pslg.points, places, domain.tolerance);
  if (domain.pslg.points != before) repair(domain.pslg, domain.name);
}

Triangulation triangulated(const NewDomain& domain) {
  try {
    return triangulate(domain.pslg);
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    throw InputError(domain.name + ": " + error.what());
  }
}

void require_regions(const Mesh& mesh, const NewDomain& domain) {
  const auto named = std::ranges::find_if(mesh.regions, [](double attribute) { return attribute != 0; });
  if (named != mesh.regions.end() && domain.pslg.regions.empty())
    throw InputError({domain.name}, "has no regions, but the mesh has", "give the new outline those of the mesh");
}

class Search {
 public:
  Search(const Mesh& mesh, const TriangleNeighbors& beyond, const NewDomain& domain)
      : mesh_(mesh),
        beyond_(beyond),
        domain_(domain),
        made_(triangulated(domain)),
        locator_(made_),
        index_(mesh),
        rounding_(rounding_of_midpoints(mesh.points)),
        on_gone_(mesh.points.size(), false),
        on_line_(mesh.points.size(), false) {}

  OutlineChange run() {
    change_.match = match_outlines(mesh_, index_, domain_, made_);
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
      for (const std::int32_t v : {mesh_.edges[e].a, mesh_.edges[e].b})
        (change_.match.gone[e] ? on_gone_ : on_line_)[to_index(v)] = true;
    std::vector<Box> boxes;
    for (const Piece& piece : change_.match.pieces) boxes.push_back(Box::around(piece.end[0], piece.end[1], rounding_));
    pieces_ = BoxTree(boxes);
    require_weirs();
    add_touched();
    add_areas();
    if (!change_.match.pieces.empty() && std::ranges::find(change_.inside, true) == change_.inside.end()) add_nearest();
    drop_points();
    return std::move(change_);
  }

 private:
  [[nodiscard]] CornerPoints corners(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.points[to_index(a)], mesh_.points[to_index(b)], mesh_.points[to_index(c)]};
  }

  void require_weirs() const {
    for (const Mesh::Weir& weir : mesh_.weirs)
      for (const auto* points : {&weir.points, &weir.across})
        for (const std::int32_t v : *points)
          if (on_gone_[to_index(v)])
            throw Error("the new outline differs at point " + std::to_string(v) +
                        " (counted from 0), which belongs to a weir; outlines at weirs must stay as they are");
  }

  void add_touched() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      bool touched = std::ranges::any_of(mesh_.triangles[t], [&](std::int32_t v) { return on_gone_[to_index(v)]; });
      const CornerPoints points = corners(t);
      const Box box = Box::of(points);
      pieces_.search([&](const Box& other) { return !touched && other.overlaps(box); },
                     [&](std::int32_t i) { touched = touched || touch(change_.match.pieces[to_index(i)], points); });
      change_.inside.push_back(touched);
    }
  }

  /// Triangles between which no line passes are in the domain together, or not.
  void add_areas() {
    std::vector<bool> seen = change_.inside;
    std::vector<std::int32_t> area;
    for (std::size_t first = 0; first < seen.size(); ++first) {
      if (seen[first]) continue;
      seen[first] = true;
      area.assign(1, static_cast<std::int32_t>(first));
      for (std::size_t k = 0; k < area.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i) {
          const std::int32_t other = beyond_[to_index(area[k])][i];
          const auto& v = mesh_.triangles[to_index(area[k])];
          if (other < 0 || seen[to_index(other)] || index_.find(v[(i + 1) % 3], v[(i + 2) % 3]) >= 0) continue;
          seen[to_index(other)] = true;
          area.push_back(other);
        }
      const adapt::Locator::Place place = locator_.locate(centroid(corners(first)));
      if (!place.beyond && region_of(mesh_, domain_, made_, place.triangle) == region_of(mesh_, area[0])) continue;
      for (const std::int32_t t : area) change_.inside[to_index(t)] = true;
    }
  }

  /// A domain that touches nothing of the mesh takes its lengths and values from there.
  void add_nearest() {
    const Point& at = change_.match.pieces[0].end[0];
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (const double distance = squared_distance(centroid(corners(t)), at); distance < least) {
        least = distance;
        nearest = t;
      }
    change_.inside[nearest] = true;
  }

  [[nodiscard]] bool is_on_piece(const Point& p) const {
    bool on = false;
    pieces_.visit_containing(p, [&](std::int32_t i) {
      const auto& [a, b] = change_.match.pieces[to_index(i)].end;
      on = on || squared_distance_to_segment(p, a, b) <= rounding_ * rounding_;
    });
    return on;
  }

  void drop_points() {
    if (mesh_.point_markers.empty()) return;
    std::vector<bool> seen(mesh_.points.size(), false);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!change_.inside[t]) continue;
      for (const std::int32_t v : mesh_.triangles[t]) {
        const std::size_t i = to_index(v);
        if (seen[i] || on_line_[i] || mesh_.point_markers[i] == 0) continue;
        seen[i] = true;
        if (on_gone_[i] || is_on_piece(mesh_.points[i]) || locator_.locate(mesh_.points[i]).beyond)
          change_.dropped.push_back(v);
      }
    }
    std::ranges::sort(change_.dropped);
  }

  const Mesh& mesh_;
  const TriangleNeighbors& beyond_;
  const NewDomain& domain_;
  Triangulation made_;
  adapt::Locator locator_;
  ConstrainedEdgeIndex index_;
  double rounding_;
  std::vector<bool> on_gone_, on_line_;  // points
  BoxTree pieces_;
  OutlineChange change_;
};

}  // namespace

OutlineChange compare_outlines(Mesh& mesh, NewDomain domain) {
  require_regions(mesh, domain);
  const TriangleNeighbors beyond = triangle_neighbors(mesh);
  const std::size_t listed = mesh.edges.size();
  list_borders(mesh, beyond);
  settle(domain, mesh);
  OutlineChange change = Search(mesh, beyond, domain).run();
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (e >= listed)
      mesh.edges[e].marker = change.match.markers[e];
    else if (mesh.edges[e].marker != change.match.markers[e])
      ++change.other_markers;
  }
  return change;
}

}  // namespace driftmesh::patch
