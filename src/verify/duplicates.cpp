#include "verify/duplicates.hpp"

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {

void check_duplicates(const NamedMesh& mesh, const PointFilter& counts, const PointFilter& is_new, PointIndex& index,
                      Findings& findings) {
  for (const std::int32_t v : first_ids<std::int32_t>(mesh.mesh().points.size())) {
    if (!counts(v)) continue;
    const std::int32_t first = index.add(v);
    if (first != v && (is_new(v) || is_new(first)))
      findings.add(Flaw::kDuplicatePoint, [&] {
        return point_words(mesh, v) + formatted(" has the coordinates of point {}", mesh.number(first));
      });
  }
}

}  // namespace driftmesh
