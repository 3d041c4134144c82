#include "verify/point_data_check.hpp"

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

/// Which markers points have from the subsegments that they are on.
class MarkersOfSubsegments {
 public:
  explicit MarkersOfSubsegments(const Mesh& mesh) {
    for (const Mesh::Edge& edge : mesh.edges)
      for (const std::int32_t v : {edge.a, edge.b})
        for (const std::int32_t marker : {edge.marker, 1}) markers_.emplace(v, marker);
  }
  [[nodiscard]] bool give(std::int32_t vertex, std::int32_t marker) const {
    return markers_.contains({vertex, marker});
  }

 private:
  std::set<std::pair<std::int32_t, std::int32_t>> markers_;
};

void check_markers(const NamedMesh& names, const Pslg& input, const PointIndex& mesh_points, Findings& findings) {
  const Mesh& mesh = names.mesh();
  std::vector<std::pair<std::int32_t, std::size_t>> unlike;  // vertex and point
  for (std::size_t i = 0; i < input.points.size(); ++i)
    if (const std::int32_t v = mesh_points.find(input.points[i]);
        v != kNone && mesh.point_markers[v] != input.point_markers[i])
      unlike.emplace_back(v, i);
  if (unlike.empty()) return;
  const MarkersOfSubsegments subsegments(mesh);
  for (const auto& [v, i] : unlike) {
    const std::int32_t actual = mesh.point_markers[v], expected = input.point_markers[i];
    if (expected == 0 && subsegments.give(v, actual)) continue;
    findings.add(Flaw::kWrongPointMarker, [&, vertex = v] {
      return formatted("{} has marker {}, expected {}", point_words(names, vertex), actual, expected);
    });
  }
}

void check_attributes(const NamedMesh& names, const Pslg& input, const PointIndex& mesh_points, Findings& findings) {
  const Mesh& mesh = names.mesh();
  if (mesh.attributes_per_point != input.attributes_per_point) {
    findings.add(Flaw::kWrongAttribute, [&] {
      return formatted("points have {} attributes, expected {}", mesh.attributes_per_point, input.attributes_per_point);
    });
    return;
  }
  const std::size_t width = input.attributes_per_point;
  for (std::size_t i = 0; i < input.points.size(); ++i) {
    const std::int32_t v = mesh_points.find(input.points[i]);
    for (std::size_t k = 0; k < width && v != kNone; ++k) {
      const double actual = mesh.attributes[to_index(v) * width + k], expected = input.attributes[i * width + k];
      if (actual != expected)
        findings.add(Flaw::kWrongAttribute, [&] {
          return formatted("{} has {} as attribute {}, expected {}", point_words(names, v), actual, k + 1, expected);
        });
    }
  }
}

}  // namespace

void check_point_data(const NamedMesh& mesh, const Pslg& input, const PointIndex& mesh_points, Findings& findings) {
  if (!mesh.mesh().point_markers.empty() && !input.point_markers.empty())
    check_markers(mesh, input, mesh_points, findings);
  if (mesh.mesh().attributes_per_point > 0 && input.attributes_per_point > 0)
    check_attributes(mesh, input, mesh_points, findings);
}

}  // namespace driftmesh
