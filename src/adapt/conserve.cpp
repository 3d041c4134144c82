#include "adapt/conserve.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "adapt/interpolate.hpp"
#include "adapt/overlaps.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

using Weights = std::array<double, 3>;

double area_of(const Triangulation& mesh, TriangleId t) {
  return signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// p as a combination of the corners of a triangle, not only for points inside.
Weights weights_in(const Triangulation& mesh, TriangleId t, const Point& p) {
  const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
  const double all = rounded_cross(a, b, c);
  const double at_b = rounded_cross(c, a, p) / all, at_c = rounded_cross(a, b, p) / all;
  return {1 - at_b - at_c, at_b, at_c};
}

/// Calls sum(weight, p) so that the weighted values of a function add up to its integral over a convex polygon, exactly
/// for products of two linear ones: at the midpoints of edges of the triangles that the polygon is divided into.
template <class Sum>
void integrate(const std::vector<Point>& polygon, const Sum& sum) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Point &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
    const double weight = signed_area(a, b, c) / 3;
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      sum(weight, Point{(p.x + q.x) / 2, (p.y + q.y) / 2});
  }
}

/// For each old triangle its area over the sum of its overlaps, 1 but for rounding.
IdVector<TriangleId, double> corrections(const Triangulation& mesh, const std::vector<Overlap>& overlaps) {
  IdVector<TriangleId, double> sum(mesh.triangles.size(), 0);
  for (const Overlap& o : overlaps) sum[o.old_triangle] += o.area;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (sum[t] > 0) sum[t] = area_of(mesh, t) / sum[t];
  return sum;
}

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// Overlaps of triangles that are new with those that are gone. Others have none but for rounding.
std::vector<Overlap> overlaps_in(const Lineage::Change& change) {
  IdVector<TriangleId, bool> stays(change.old_mesh.triangles.size(), false);
  for (const TriangleId from : change.same)
    if (from != kNone) stays[from] = true;
  std::vector<Overlap> overlaps =
      overlaps_of(change.old_mesh, change.new_mesh, [&](TriangleId t) { return change.same[t] == kNone; });
  std::erase_if(overlaps, [&](const Overlap& o) { return stays[o.old_triangle]; });
  return overlaps;
}

/// Calls visit(change, overlaps, corrections) for each subdomain that has changed, for several at once.
template <class Visit>
void visit_overlaps(const Lineage& lineage, const Visit& visit) {
  lineage.visit_parts([&](SubdomainId /*s*/, const Lineage::Change& change) {
    if (change.is_the_same) return;
    const std::vector<Overlap> overlaps = overlaps_in(change);
    visit(change, overlaps, corrections(change.old_mesh, overlaps));
  });
}

}  // namespace

std::vector<double> conserved_at_triangles(const Lineage& lineage, const std::vector<double>& old,
                                           std::size_t components) {
  std::vector<double> values(lineage.new_triangles() * components);
  lineage.visit_same_triangles([&](std::int32_t triangle, std::int32_t from, int /*turn*/) {
    std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(to_index(from) * components), components,
                values.begin() + static_cast<std::ptrdiff_t>(to_index(triangle) * components));
  });
  visit_overlaps(lineage, [&](const Lineage::Change& change, const std::vector<Overlap>& overlaps,
                              const IdVector<TriangleId, double>& correction) {
    for (const Overlap& o : overlaps)
      for (std::size_t k = 0; k < components; ++k) {
        const double from = old[to_index(change.old_number[o.old_triangle]) * components + k];
        values[to_index(change.new_number[o.new_triangle]) * components + k] +=
            from * o.area * correction[o.old_triangle];
      }
    for (const TriangleId t : ids_of(change.new_number))
      if (change.new_number[t] != kNone && change.same[t] == kNone)
        for (std::size_t k = 0; k < components; ++k)
          values[to_index(change.new_number[t]) * components + k] /= area_of(change.new_mesh, t);
  });
  return values;
}

std::vector<double> conserved_at_corners(const Lineage& lineage, const std::vector<double>& old,
                                         std::size_t components) {
  const auto place = [components](std::int32_t triangle, int corner, std::size_t k) {
    return (3 * to_index(triangle) + static_cast<std::size_t>(corner)) * components + k;
  };
  std::vector<double> values(3 * lineage.new_triangles() * components);
  lineage.visit_same_triangles([&](std::int32_t triangle, std::int32_t from, int turn) {
    for (int i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < components; ++k) values[place(triangle, i, k)] = old[place(from, (i + turn) % 3, k)];
  });
  visit_overlaps(lineage, [&](const Lineage::Change& change, const std::vector<Overlap>& overlaps,
                              const IdVector<TriangleId, double>& correction) {
    for (std::size_t first = 0; first < overlaps.size();) {
      const TriangleId t = overlaps[first].new_triangle;
      std::size_t end = first;
      while (end < overlaps.size() && overlaps[end].new_triangle == t) ++end;
      for (std::size_t k = 0; k < components; ++k) {
        Weights moments{};  // integrals with the function of each corner
        Range range;
        for (std::size_t j = first; j < end; ++j) {
          const Overlap& o = overlaps[j];
          std::array<double, 3> at{};
          for (int i = 0; i < 3; ++i) {
            at[i] = old[place(change.old_number[o.old_triangle], i, k)];
            range.add(at[i]);
          }
          integrate(o.corners, [&](double weight, const Point& p) {
            const Weights from = weights_in(change.old_mesh, o.old_triangle, p), to = weights_in(change.new_mesh, t, p);
            const double value = from[0] * at[0] + from[1] * at[1] + from[2] * at[2];
            for (int i = 0; i < 3; ++i) moments[i] += correction[o.old_triangle] * weight * value * to[i];
          });
        }
        const double all = moments[0] + moments[1] + moments[2], area = area_of(change.new_mesh, t);
        const double mean = all / area;
        std::array<double, 3> off_mean{};
        double share = 1;  // of the differences from the mean
        for (int i = 0; i < 3; ++i) {
          off_mean[i] = 12 / area * (moments[i] - all / 4) - mean;
          const double room = off_mean[i] > 0 ? range.most - mean : range.least - mean;
          if (off_mean[i] != 0) share = std::min(share, std::max(0.0, room / off_mean[i]));
        }
        for (int i = 0; i < 3; ++i) values[place(change.new_number[t], i, k)] = mean + share * off_mean[i];
      }
      first = end;
    }
  });
  return values;
}

std::vector<double> conserved_at_points(const Lineage& lineage, const std::vector<double>& old,
                                        std::size_t components) {
  const std::size_t points = lineage.new_points();
  // Of each subdomain, since sums over those that share a point are formed in the order of their numbers.
  struct Share {
    std::vector<std::int32_t> point;
    std::vector<double> moments;  // integrals of the field with the function of each point
    std::vector<double> mass;     // of that function alone
    std::vector<bool> changed;    // a triangle at the point does not stay
  };
  IdVector<SubdomainId, Share> shares(lineage.subdomains());
  lineage.visit_parts([&](SubdomainId s, const Lineage::Change& change) {
    Share& share = shares[s];
    const std::size_t vertices = change.new_mesh.points.size();
    share.point.assign(change.new_place.begin(), change.new_place.end());
    share.moments.assign(vertices * components, 0);
    share.mass.assign(vertices, 0);
    share.changed.assign(vertices, false);
    for (const TriangleId t : ids_of(change.new_mesh.triangles)) {
      if (!change.new_mesh.triangles[t].alive()) continue;
      const double third = area_of(change.new_mesh, t) / 3;
      const bool stays = change.is_the_same || change.same[t] != kNone;
      for (const VertexId v : change.new_mesh.triangles[t].vertex) {
        share.mass[to_index(v)] += third;
        if (!stays) share.changed[to_index(v)] = true;
        if (!stays) continue;
        const std::int32_t from = lineage.old_point_of(s, v);
        for (std::size_t k = 0; k < components; ++k)
          share.moments[to_index(v) * components + k] += third * old[to_index(from) * components + k];
      }
    }
    if (change.is_the_same) return;
    const std::vector<Overlap> overlaps = overlaps_in(change);
    const IdVector<TriangleId, double> correction = corrections(change.old_mesh, overlaps);
    for (const Overlap& o : overlaps) {
      const auto& from = change.old_mesh.triangles[o.old_triangle].vertex;
      const auto& to = change.new_mesh.triangles[o.new_triangle].vertex;
      integrate(o.corners, [&](double weight, const Point& p) {
        const Weights in_old = weights_in(change.old_mesh, o.old_triangle, p),
                      in_new = weights_in(change.new_mesh, o.new_triangle, p);
        for (std::size_t k = 0; k < components; ++k) {
          double value = 0;
          for (int i = 0; i < 3; ++i) value += in_old[i] * old[to_index(change.old_place[from[i]]) * components + k];
          for (int i = 0; i < 3; ++i)
            share.moments[to_index(to[i]) * components + k] += correction[o.old_triangle] * weight * value * in_new[i];
        }
      });
    }
  });

  std::vector<double> low(points * components), mass(points);
  std::vector<bool> changed(points, false);
  for (const Share& share : shares)
    for (std::size_t v = 0; v < share.point.size(); ++v) {
      if (share.point[v] == kNone) continue;
      const std::size_t i = to_index(share.point[v]);
      mass[i] += share.mass[v];
      if (share.changed[v]) changed[i] = true;
      for (std::size_t k = 0; k < components; ++k) low[i * components + k] += share.moments[v * components + k];
    }
  std::vector<double> values = interpolated_at_points(lineage, old, components);
  for (std::size_t k = 0; k < components; ++k) {
    double missing = 0, upward = 0, downward = 0;
    for (std::size_t i = 0; i < points; ++i) {
      if (!changed[i]) continue;
      const double step = low[i * components + k] - mass[i] * values[i * components + k];
      missing += step;
      (step > 0 ? upward : downward) += step;
    }
    const double possible = missing > 0 ? upward : downward;
    if (possible == 0) continue;
    const double share = std::clamp(missing / possible, 0.0, 1.0);
    for (std::size_t i = 0; i < points; ++i) {
      if (!changed[i]) continue;
      const double step = low[i * components + k] - mass[i] * values[i * components + k];
      if ((step > 0) == (missing > 0)) values[i * components + k] += share * step / mass[i];
    }
  }
  return values;
}

}  // namespace driftmesh::adapt
