#include "mesh/interpolate_attributes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "mesh/cdt.hpp"
#include "sizing/background_mesh.hpp"

namespace driftmesh {
namespace {

constexpr auto id = &Triangulation::id;

/// The triangles of the input, with corners that are indices into the points of the PSLG.
std::vector<BackgroundMesh::Triangle> input_triangles(const Triangulation& initial) {
  std::vector<BackgroundMesh::Triangle> triangles;
  for (const Triangle& t : initial.triangles)
    if (t.alive())
      triangles.push_back(
          {initial.origin[id(t.vertex[0])], initial.origin[id(t.vertex[1])], initial.origin[id(t.vertex[2])]});
  return triangles;
}

}  // namespace

void interpolate_attributes(const Pslg& pslg, MeshPiece& piece) {
  if (pslg.attributes_per_point == 0) return;
  const auto width = static_cast<std::size_t>(pslg.attributes_per_point);
  const Triangulation initial = triangulate(pslg);
  const auto input_points =
      static_cast<std::size_t>(std::count_if(initial.origin.begin(), initial.origin.end(), is_input));
  const BackgroundMesh background(pslg.points, input_triangles(initial));
  for (std::size_t v = input_points; v < piece.points.size(); ++v) {
    const BackgroundMesh::Place place = background.locate(piece.points[v]);
    const BackgroundMesh::Triangle& corners = background.triangles()[id(place.triangle)];
    for (std::size_t k = 0; k < width; ++k) {
      double& value = piece.attributes[v * width + k];
      value = 0;
      for (std::size_t i = 0; i < 3; ++i) value += place.weight[i] * pslg.attributes[id(corners[i]) * width + k];
    }
  }
}

}  // namespace driftmesh
