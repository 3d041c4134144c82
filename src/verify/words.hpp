#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

// How messages name parts of a mesh; numbers count from 0.

/// "triangle 7 (1 2 3)"
[[nodiscard]] std::string triangle_words(const Mesh& mesh, std::size_t triangle);
/// "point 4 at (0.5, 1)"
[[nodiscard]] std::string point_words(const Mesh& mesh, std::int32_t point);
/// "edge 1-2 from (0, 0) to (1, 0)"
[[nodiscard]] std::string edge_words(const Mesh& mesh, std::int32_t u, std::int32_t v);
/// "(0.5, 1)", with all digits
[[nodiscard]] std::string place_words(const Point& p);

}  // namespace driftmesh
