#include "patch/new_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/segment_geometry.hpp"

namespace driftmesh::patch {
namespace {

/// A segment of the new domain.
struct Root {
  std::array<Point, 2> end;
  std::optional<double> left, right;
  std::int32_t marker = 0;
  struct Covered {
    double from, to;  // along the segment, 0 to 1
    Point first, last;
  };
  std::vector<Covered> covered;  // by edges of the mesh

  [[nodiscard]] double along(const Point& p) const {
    const double dx = end[1].x - end[0].x, dy = end[1].y - end[0].y;
    return ((p.x - end[0].x) * dx + (p.y - end[0].y) * dy) / (dx * dx + dy * dy);
  }
};

class Matching {
 public:
  Matching(const Mesh& mesh, const NewDomain& domain, const Triangulation& made)
      : mesh_(mesh), domain_(domain), made_(made) {
    std::vector<Box> boxes;
    for (const RootId r : ids_of(made.roots)) {
      const Subsegment& whole = made.subsegments[made.roots[r].tree];
      roots_.push_back({{made.points[whole.vertex[0]], made.points[whole.vertex[1]]},
                        side(whole.half[0]),
                        side(whole.half[1]),
                        made.roots[r].marker,
                        {}});
      boxes.push_back(Box::around(roots_.back().end[0], roots_.back().end[1], domain.tolerance));
    }
    tree_ = BoxTree(boxes);
  }

  OutlineMatch run(const ConstrainedEdgeIndex& index) {
    const auto at_edges = triangles_at_edges(mesh_, index);
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      match_.markers.push_back(mesh_.edges[e].marker);
      match_.gone.push_back(!cover(e, at_edges[e]));
    }
    add_pieces();
    add_points();
    return std::move(match_);
  }

 private:
  [[nodiscard]] std::optional<double> side(HalfEdge h) const {
    if (h == kNone) return std::nullopt;
    return region_of(mesh_, domain_, made_, triangle_of(h));
  }
  [[nodiscard]] std::optional<double> side(std::int32_t triangle) const {
    if (triangle < 0) return std::nullopt;
    return region_of(mesh_, triangle);
  }

  /// Whether the edge is on a segment that has the same on both sides.
  bool cover(std::size_t e, const std::array<std::int32_t, 2>& triangles) {
    const Point &a = mesh_.points[to_index(mesh_.edges[e].a)], &b = mesh_.points[to_index(mesh_.edges[e].b)];
    const std::optional<double> left = side(triangles[0]), right = side(triangles[1]);
    if (!left && !right) return true;  // no triangle has it: it is what it was
    double least = domain_.tolerance * domain_.tolerance;
    Root* best = nullptr;
    bool turned = false;
    tree_.search([&](const Box& box) { return box.contains(a) && box.contains(b); },
                 [&](std::int32_t i) {
                   Root& root = roots_[to_index(i)];
                   const double distance = std::max(squared_distance_to_segment(a, root.end[0], root.end[1]),
                                                    squared_distance_to_segment(b, root.end[0], root.end[1]));
                   const bool against = root.along(b) < root.along(a);
                   if (distance > least || (best != nullptr && distance == least)) return;
                   if (left != (against ? root.right : root.left) || right != (against ? root.left : root.right))
                     return;
                   least = distance;
                   best = &root;
                   turned = against;
                 });
    if (best == nullptr) return false;
    best->covered.push_back(turned ? Root::Covered{best->along(b), best->along(a), b, a}
                                   : Root::Covered{best->along(a), best->along(b), a, b});
    match_.markers[e] = best->marker;
    return true;
  }

  void add_pieces() {
    for (Root& root : roots_) {
      std::ranges::sort(root.covered, {}, &Root::Covered::from);
      Point at = root.end[0];
      double reached = -std::numeric_limits<double>::infinity();
      for (const Root::Covered& covered : root.covered) {
        if (covered.from < reached)
          throw Error(
              formatted("at ({}, {}) several lines of the old outline are within the tolerance of one of the new one; "
                        "ask for a smaller tolerance",
                        covered.first.x, covered.first.y));
        reached = covered.to;
        if (!(at == covered.first)) add_piece(root, at, covered.first);
        at = covered.last;
      }
      if (!(at == root.end[1])) add_piece(root, at, root.end[1]);
    }
  }

  void add_piece(const Root& root, const Point& a, const Point& b) {
    match_.pieces.push_back({{a, b}, {}, root.marker, root.left, root.right});
  }

  /// Points on no segment are pieces without a length, unless the mesh has them.
  void add_points() {
    std::vector<bool> on_segment(made_.points.size(), false);
    for (const RootId r : ids_of(made_.roots))
      for (const VertexId v : made_.subsegments[made_.roots[r].tree].vertex) on_segment[to_index(v)] = true;
    const auto order = [](const Point& p, const Point& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; };
    std::map<Point, std::int32_t, decltype(order)> markers(order), alone(order);
    for (const VertexId v : ids_of(made_.points)) {
      if (!is_input(made_.origin[v])) continue;
      const Pslg& pslg = domain_.pslg;
      const std::int32_t marker = pslg.point_markers.empty() ? 0 : pslg.point_markers[to_index(made_.origin[v])];
      match_.corners.push_back(made_.points[v]);
      if (marker != 0) markers[made_.points[v]] = marker;
      if (!on_segment[to_index(v)]) alone[made_.points[v]] = marker;
    }
    if (!alone.empty())
      for (const Point& p : mesh_.points) alone.erase(p);
    for (const auto& [p, marker] : alone) match_.pieces.push_back({{p, p}, {}, 0, 0, 0});
    for (Piece& piece : match_.pieces)
      for (std::size_t i = 0; i < 2; ++i)
        if (const auto found = markers.find(piece.end[i]); found != markers.end())
          piece.end_marker[i] = found->second;
        else
          piece.end_marker[i] = piece.marker;
  }

  const Mesh& mesh_;
  const NewDomain& domain_;
  const Triangulation& made_;
  std::vector<Root> roots_;
  BoxTree tree_;
  OutlineMatch match_;
};

/// Of each number of the domain the one that it gets.
template <class Number>
std::map<Number, Number> renumbered(const std::set<Number>& numbers, const std::map<Number, std::string>& names,
                                    const std::set<Number>& in_mesh, std::map<Number, std::string>& names_of_mesh) {
  std::map<Number, Number> now;
  std::set<Number> taken = in_mesh;
  for (const auto& [number, name] : names_of_mesh) taken.insert(number);
  for (const Number number : numbers) {
    now[number] = number;
    const auto name = names.find(number);
    if (name == names.end()) continue;
    const auto known =
        std::ranges::find_if(names_of_mesh, [&](const auto& entry) { return entry.second == name->second; });
    if (known != names_of_mesh.end()) {
      now[number] = known->first;
      continue;
    }
    Number& own = now[number];
    if (names_of_mesh.contains(number))
      for (own = 1; taken.contains(own) || numbers.contains(own);) ++own;
    names_of_mesh[own] = name->second;
    taken.insert(own);
  }
  return now;
}

}  // namespace

double rounding_of_midpoints(const std::vector<Point>& points) {
  const Box box = Box::of(points);
  const double most =
      std::max({std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.high.x), std::fabs(box.high.y)});
  return 16 * std::numeric_limits<double>::epsilon() * most;
}

void adopt_names(Pslg& domain, Mesh& mesh) {
  std::set<std::int32_t> markers, in_mesh;
  for (const Pslg::Segment& segment : domain.segments) markers.insert(segment.marker);
  for (const Mesh::Edge& edge : mesh.edges) in_mesh.insert(edge.marker);
  const auto marker_now = renumbered(markers, domain.names.markers, in_mesh, mesh.names.markers);
  for (Pslg::Segment& segment : domain.segments) segment.marker = marker_now.at(segment.marker);
  for (std::int32_t& marker : domain.point_markers)
    if (const auto found = marker_now.find(marker); found != marker_now.end()) marker = found->second;
  std::set<double> regions;
  for (const Pslg::Region& region : domain.regions) regions.insert(region.attribute);
  const auto region_now =
      renumbered(regions, domain.names.regions, std::set(mesh.regions.begin(), mesh.regions.end()), mesh.names.regions);
  for (Pslg::Region& region : domain.regions) region.attribute = region_now.at(region.attribute);
}

OutlineMatch match_outlines(const Mesh& mesh, const ConstrainedEdgeIndex& index, const NewDomain& domain,
                            const Triangulation& made) {
  return Matching(mesh, domain, made).run(index);
}

double region_of(const Mesh& mesh, std::int32_t triangle) {
  return mesh.regions.empty() ? 0 : mesh.regions[to_index(triangle)];
}

double region_of(const Mesh& mesh, const NewDomain& domain, const Triangulation& made, TriangleId triangle) {
  if (mesh.regions.empty() || made.region.empty() || made.region[triangle] == 0) return 0;
  return domain.pslg.regions[made.region[triangle] - 1U].attribute;
}

}  // namespace driftmesh::patch
