#include "mesh/interpolate_attributes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "mesh/cdt.hpp"

namespace driftmesh {
namespace {

/// The triangles of the input, with corners that are indices into the points of the PSLG.
std::vector<BackgroundMesh::Triangle> input_triangles(const Triangulation& initial) {
  std::vector<BackgroundMesh::Triangle> triangles;
  for (const Triangle& t : initial.triangles)
    if (t.alive())
      triangles.push_back({initial.origin[t.vertex[0]], initial.origin[t.vertex[1]], initial.origin[t.vertex[2]]});
  return triangles;
}

}  // namespace

AttributeField::AttributeField(const Pslg& pslg) : AttributeField(pslg, triangulate(pslg)) {}

AttributeField::AttributeField(const Pslg& pslg, const Triangulation& initial)
    : pslg_(pslg),
      used_points_(std::count_if(initial.origin.begin(), initial.origin.end(), is_input)),
      background_(pslg.points, input_triangles(initial)) {}

void AttributeField::evaluate(const Point& p, std::span<double> values) const {
  const BackgroundMesh::Place place = background_.locate(p);
  const BackgroundMesh::Triangle& corners = background_.triangles()[place.triangle];
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = 0;
    for (std::size_t i = 0; i < 3; ++i) values[k] += place.weight[i] * pslg_.attributes[corners[i] * values.size() + k];
  }
}

void AttributeField::evaluate(VertexOrigin origin, const Point& p, std::span<double> values) const {
  if (!is_input(origin)) return evaluate(p, values);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = pslg_.attributes[origin * values.size() + k];
}

void interpolate_attributes(const Pslg& pslg, Mesh& piece) {
  if (pslg.attributes_per_point == 0) return;
  const std::size_t width = pslg.attributes_per_point;
  const AttributeField field(pslg);
  for (std::size_t v = field.used_points(); v < piece.points.size(); ++v)
    field.evaluate(piece.points[v], std::span(piece.attributes).subspan(v * width, width));
}

}  // namespace driftmesh
