#include "patch/lengths.hpp"

#include <algorithm>
#include <limits>

#include "adapt/length_growth.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/bound_forecast.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::patch {
namespace {

/// Twice the areas of the triangles at a point.
struct Around {
  double sum = 0, most = 0;
  std::int32_t count = 0;
  bool inside = false;
  [[nodiscard]] double mean() const { return sum / count; }
};

IdVector<VertexId, Around> look_around(const Triangulation& mesh, const Extent& extent) {
  IdVector<VertexId, Around> all(mesh.points.size());
  for (const TriangleId t : ids_of(mesh.triangles)) {
    const double twice = 2 * signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    for (const VertexId v : mesh.triangles[t].vertex) {
      Around& around = all[v];
      around.sum += twice;
      around.most = std::max(around.most, twice);
      ++around.count;
      around.inside = around.inside || extent.inside[to_index(t)];
    }
  }
  return all;
}

}  // namespace

adapt::Lengths lengths_in(const Part& part, const Triangulation& mesh, const Extent& extent,
                          std::span<const double> asked, const AdaptiveOptions& options) {
  constexpr double kRoom = 1.001;  // no triangle that stays is too large
  const IdVector<VertexId, Around> around = look_around(mesh, extent);
  adapt::Lengths lengths;
  for (const VertexId v : ids_of(around)) {
    double length = std::numeric_limits<double>::infinity();
    if (around[v].inside) {
      length = asked.empty() ? edge_of_twice_area(kTrianglesPerBound * around[v].mean())
                             : asked[to_index(part.point[to_index(v)])];
      length = std::clamp(length, options.shortest, options.longest);
    }
    lengths.push_back(length);
  }
  if (!asked.empty() && options.gradation > 0) static_cast<void>(adapt::limit_growth(mesh, options.gradation, lengths));
  for (const VertexId v : ids_of(around))
    if (!around[v].inside) lengths[v] = kRoom * edge_of_twice_area(around[v].most);
  return lengths;
}

}  // namespace driftmesh::patch
