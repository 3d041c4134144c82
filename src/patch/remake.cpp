#include "patch/remake.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adapt/linear_lengths.hpp"
#include "adapt/locator.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"
#include "patch/attempt.hpp"
#include "patch/carry.hpp"
#include "patch/domain.hpp"
#include "patch/flaws.hpp"
#include "patch/lengths.hpp"
#include "patch/neighborhood.hpp"
#include "patch/old_places.hpp"
#include "patch/outline_change.hpp"
#include "patch/part.hpp"
#include "patch/splice.hpp"

namespace driftmesh::patch {
namespace {

/// Layers of triangles around what is made anew in which refinement may fade out. Where these are too few, it gets
/// more.
constexpr int kLayers = 3;
constexpr int kMostRounds = 12;

void require_lengths(const Mesh& mesh, const std::vector<double>& lengths) {
  if (lengths.empty()) return;
  if (lengths.size() != mesh.points.size())
    throw Error(formatted("there are {} lengths for {} points; give one for each", lengths.size(), mesh.points.size()));
  for (std::size_t v = 0; v < lengths.size(); ++v)
    if (!(lengths[v] > 0))
      throw Error(
          formatted("the length at point {} (counted from 0) is {}; lengths must be greater than 0", v, lengths[v]));
}

void require_counterclockwise(const Part& part) {
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = part.mesh.triangles[t];
    const auto at = [&](std::int32_t v) { return part.mesh.points[to_index(v)]; };
    if (!(orient2d(at(a), at(b), at(c)) > 0))
      throw Error("triangle " + std::to_string(part.triangle[t]) +
                  " (counted from 0) is clockwise or flat; driftmesh check lists all of them");
  }
}

/// A mesh of a program that lists no edges has those of its boundary.
void list_boundary(Mesh& mesh, const std::optional<Linked>& linked) {
  if (!mesh.edges.empty()) return;
  const TriangleNeighbors beyond = linked ? linked->beyond : triangle_neighbors(mesh);
  for (std::size_t t = 0; t < beyond.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (beyond[t][i] < 0) mesh.edges.push_back({mesh.triangles[t][(i + 1) % 3], mesh.triangles[t][(i + 2) % 3], 0});
}

/// What a new outline changes about a part.
void apply(const OutlineChange& change, const Part& part, const OldPlaces& old, Extent& extent) {
  for (const std::int32_t e : part.edge) extent.gone.push_back(change.match.gone[to_index(e)]);
  for (const std::int32_t v : part.point) extent.dropped.push_back(std::ranges::binary_search(change.dropped, v));
  extent.pieces = change.match.pieces;
  for (const Point& p : change.match.corners)
    if (const std::int32_t v = old.point_at(p); v >= 0) extent.held[to_index(v)] = true;
}

Extent extent_of(const Mesh& mesh, const Part& part, const Neighborhood& taken, const std::vector<bool>& inside) {
  Extent extent;
  for (const std::int32_t t : part.triangle) {
    extent.taken.push_back(taken.takes(t));
    extent.inside.push_back(inside[to_index(t)]);
  }
  extent.held.assign(part.point.size(), false);
  const auto hold = [&](std::int32_t v) {
    const auto found = std::ranges::lower_bound(part.point, v);
    if (found != part.point.end() && *found == v)
      extent.held[static_cast<std::size_t>(found - part.point.begin())] = true;
  };
  for (const Mesh::Weir& weir : mesh.weirs) {
    std::ranges::for_each(weir.points, hold);
    std::ranges::for_each(weir.across, hold);
  }
  return extent;
}

struct LinkedPart {
  Part part;
  Triangulation triangulation;
};

LinkedPart linked_part(const Mesh& mesh, const Neighborhood& taken, std::optional<Linked>& linked) {
  std::vector<std::int32_t> triangles = taken.with_rim();
  if (linked && triangles.size() == mesh.triangles.size())
    if (std::optional<Part> whole = whole_part(mesh, *linked)) {
      LinkedPart all{*std::move(whole), std::move(linked->triangulation)};
      linked.reset();
      return all;
    }
  LinkedPart some{part_of(mesh, std::move(triangles)), {}};
  some.triangulation = triangulation_of(some.part.mesh, some.part.beyond);
  return some;
}

/// A distance from what was inside within which all points of triangles are that are gone: looks along edges for points
/// inside that are near.
double margin_width(const Part& part, const Extent& extent, const std::vector<bool>& gone) {
  std::vector<std::int32_t> from(part.mesh.points.size(), kNone);
  for (std::size_t t = 0; t < gone.size(); ++t)
    if (extent.inside[t])
      for (const std::int32_t v : part.mesh.triangles[t]) from[to_index(v)] = v;
  double width = 0;
  for (bool any = true; any;) {
    any = false;
    for (std::size_t t = 0; t < gone.size(); ++t) {
      if (!gone[t] || extent.inside[t]) continue;
      for (const std::int32_t v : part.mesh.triangles[t])
        for (const std::int32_t w : part.mesh.triangles[t]) {
          const std::int32_t source = from[to_index(w)];
          if (source == kNone || from[to_index(v)] == source) continue;
          const auto distance = [&](std::int32_t s) {
            return squared_distance(part.mesh.points[to_index(v)], part.mesh.points[to_index(s)]);
          };
          if (from[to_index(v)] != kNone && distance(from[to_index(v)]) <= distance(source)) continue;
          from[to_index(v)] = source;
          any = true;
        }
    }
  }
  for (std::size_t v = 0; v < from.size(); ++v)
    if (from[v] != kNone)
      width = std::max(width, squared_distance(part.mesh.points[v], part.mesh.points[to_index(from[v])]));
  return std::sqrt(width);
}

Report report_of(const Part& part, const Extent& extent, const NewPart& made) {
  Report report;
  std::vector<bool> gone = extent.taken;
  for (const std::int32_t old : made.old_triangle)
    if (old >= 0) gone[to_index(old)] = false;
  for (std::size_t t = 0; t < gone.size(); ++t) {
    report.inside += extent.inside[t] ? 1 : 0;
    report.gone += gone[t] ? 1 : 0;
    report.margin += gone[t] && !extent.inside[t] ? 1 : 0;
  }
  report.made = std::count(made.old_triangle.begin(), made.old_triangle.end(), -1);
  report.new_points = std::count(made.old_point.begin(), made.old_point.end(), -1);
  const auto before = static_cast<std::int64_t>(part.point.size());
  const auto kept = static_cast<std::int64_t>(made.old_point.size()) - report.new_points;
  report.gone_points = before - kept;
  report.margin_width = margin_width(part, extent, gone);
  return report;
}

Remade unchanged(Mesh mesh, std::vector<adapt::Field> fields) {
  Remade same{std::move(mesh), std::move(fields), {}, {}, {}};
  same.old_points.resize(same.mesh.points.size());
  same.old_triangles.resize(same.mesh.triangles.size());
  std::iota(same.old_points.begin(), same.old_points.end(), 0);
  std::iota(same.old_triangles.begin(), same.old_triangles.end(), 0);
  return same;
}

std::vector<std::int32_t> numbers_in_whole(const Part& part, std::vector<std::int32_t> points) {
  for (std::int32_t& point : points) point = part.point[to_index(point)];
  return points;
}

/// The change of the outline, if there is one, and its triangles among those to be made anew.
OutlineChange change_of(Mesh& mesh, const Order& order, std::vector<bool>& inside) {
  if (order.domain == nullptr) return {};
  const std::size_t listed = mesh.edges.size();
  OutlineChange change = compare_outlines(mesh, *order.domain);
  for (std::size_t t = 0; t < inside.size(); ++t) change.inside[t] = change.inside[t] || inside[t];
  inside = change.inside;
  if (std::ranges::find(inside, true) == inside.end()) mesh.edges.resize(listed);
  return change;
}

/// New points where the old mesh was not.
std::int64_t points_beyond(const Triangulation& before, const NewPart& made) {
  const adapt::Locator locator(before);
  std::int64_t count = 0;
  for (std::size_t v = 0; v < made.old_point.size(); ++v)
    if (made.old_point[v] < 0 && locator.locate(made.mesh.points[v]).beyond) ++count;
  return count;
}

/// Lengths as a size field, an object for each thread.
class Sizes {
 public:
  Sizes(const Triangulation& mesh, const adapt::Lengths& lengths, std::int32_t threads) {
    for (std::int32_t i = 0; i < threads; ++i) {
      fields_.push_back(std::make_unique<adapt::LinearLengths>(mesh, lengths));
      all_.push_back(fields_.back().get());
    }
  }
  [[nodiscard]] std::span<const SizeField* const> all() const { return all_; }

 private:
  std::vector<std::unique_ptr<adapt::LinearLengths>> fields_;
  std::vector<const SizeField*> all_;
};

}  // namespace

Remade remake(Mesh mesh, std::vector<adapt::Field> fields, Order order) {
  require_sound(mesh);
  require_lengths(mesh, order.lengths);
  std::vector<bool> inside = std::move(order.inside);
  const OutlineChange change = with_flaw_of(mesh, [&] { return change_of(mesh, order, inside); });
  if (std::ranges::find(inside, true) == inside.end()) {
    Remade same = unchanged(std::move(mesh), std::move(fields));
    same.report.other_markers = change.other_markers;
    return same;
  }
  list_boundary(mesh, order.linked);
  const double most = order.options.most_triangles;
  Neighborhood taken(mesh, inside);
  taken.grow(kLayers);
  for (int round = 0;; ++round) {
    LinkedPart linked = with_flaw_of(mesh, [&] {
      LinkedPart some = linked_part(mesh, taken, order.linked);
      require_counterclockwise(some.part);
      return some;
    });
    const Part& part = linked.part;
    Triangulation& before = linked.triangulation;
    Extent extent = extent_of(mesh, part, taken, inside);
    const OldPlaces old(part.mesh);
    if (order.domain != nullptr) apply(change, part, old, extent);
    const adapt::Lengths lengths = lengths_in(part, before, extent, order.lengths, order.options);
    const Domain domain = with_flaw_of(mesh, [&] { return domain_of(part, extent, old); });
    const Sizes sizes(before, lengths, order.threads);
    const Making making{.sizes = sizes.all(),
                        .most_triangles = most > 0 ? static_cast<std::int64_t>(most) : kMostRefined,
                        .cut_from = order.cut_from};
    const Attempt made =
        with_flaw_of(mesh, [&] { return attempt(domain, part, extent, old, {.min_angle = order.min_angle}, making); });
    if (!made.tight.empty() && round < kMostRounds &&
        taken.grow_around(numbers_in_whole(part, made.tight), kLayers + round))
      continue;
    const NewPart next = new_part(made.mesh, domain, part, extent, old);
    Remade remade;
    remade.report = report_of(part, extent, next);
    if (order.domain != nullptr) {
      remade.report.gone_edges = std::ranges::count(change.match.gone, true);
      remade.report.pieces = static_cast<std::int64_t>(change.match.pieces.size());
      remade.report.other_markers = change.other_markers;
      remade.report.beyond = points_beyond(before, next);
    }
    const Numbers numbers = splice(mesh, part, extent, next);
    carry(fields, part, next, std::move(before), numbers, order.threads);
    remade.mesh = std::move(mesh);
    remade.fields = std::move(fields);
    remade.old_points = numbers.old_points;
    remade.old_triangles = numbers.old_triangles;
    return remade;
  }
}

}  // namespace driftmesh::patch
