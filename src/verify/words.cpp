#include "verify/words.hpp"

#include "base/formatted.hpp"

namespace driftmesh {

std::string triangle_words(const TrianglePlace& place, const std::array<std::int64_t, 3>& corners) {
  const std::string piece = place.piece == kNone ? "" : formatted(" of piece {}", place.piece);
  return formatted("triangle {}{} ({} {} {})", place.triangle, piece, corners[0], corners[1], corners[2]);
}

std::string triangle_words(const NamedMesh& mesh, std::size_t triangle) {
  return triangle_words(mesh.place(triangle), mesh.numbers(triangle));
}

std::string point_words(std::int64_t number, const Point& at) {
  return formatted("point {} at {}", number, place_words(at));
}

std::string point_words(const NamedMesh& mesh, std::int32_t point) {
  return point_words(mesh.number(point), mesh.mesh().points[point]);
}

std::string edge_words(const NamedMesh& mesh, std::int32_t u, std::int32_t v) {
  const std::vector<Point>& points = mesh.mesh().points;
  return formatted("edge {}-{} from {} to {}", mesh.number(u), mesh.number(v), place_words(points[u]),
                   place_words(points[v]));
}

std::string place_words(const Point& p) {
  return formatted("({}, {})", p.x, p.y);
}

}  // namespace driftmesh
