#include "verify/words.hpp"

#include <fmt/format.h>

namespace driftmesh {

std::string triangle_words(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return fmt::format("triangle {} ({} {} {})", triangle, a, b, c);
}

std::string point_words(const Mesh& mesh, std::int32_t point) {
  return fmt::format("point {} at {}", point, place_words(mesh.points[point]));
}

std::string edge_words(const Mesh& mesh, std::int32_t u, std::int32_t v) {
  return fmt::format("edge {}-{} from {} to {}", u, v, place_words(mesh.points[u]), place_words(mesh.points[v]));
}

std::string place_words(const Point& p) {
  return fmt::format("({}, {})", p.x, p.y);
}

}  // namespace driftmesh
