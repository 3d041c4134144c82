#include "driftmesh/size_on_mesh.hpp"

#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "sizing/background_field.hpp"
#include "sizing/gradation.hpp"

namespace driftmesh {

std::shared_ptr<const SizeField> size_on_mesh(const Mesh& mesh, std::vector<double> lengths, double gradation) {
  if (lengths.size() != mesh.points.size())
    throw Error("size_on_mesh: there are " + std::to_string(lengths.size()) + " lengths for " +
                std::to_string(mesh.points.size()) + " points; give one for each");
  if (!(gradation >= 0))
    throw Error("size_on_mesh: gradation is " + std::to_string(gradation) + "; it must be at least 0");
  BackgroundMesh background(mesh.points, mesh.triangles);
  if (gradation > 0) limit_gradation(mesh.points, mesh.triangles, gradation, lengths);
  return std::make_shared<const VertexSizeField>(std::move(background), std::move(lengths));
}

}  // namespace driftmesh
