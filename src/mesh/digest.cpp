#include "mesh/digest.hpp"

#include <array>
#include <bit>
#include <cstddef>

namespace driftmesh {
namespace {

constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

bool is_less(const Point& p, const Point& q) {
  return p.x < q.x || (p.x == q.x && p.y < q.y);
}

std::uint64_t triangle_digest(const std::array<const Point*, 3>& corner) {
  std::size_t first = is_less(*corner[1], *corner[0]) ? 1 : 0;
  if (is_less(*corner[2], *corner[first])) first = 2;
  std::uint64_t h = 0x9E3779B97F4A7C15U;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point& p = *corner[(first + k) % 3];
    h = mix(h ^ std::bit_cast<std::uint64_t>(p.x + 0.0));  // -0 + 0 is 0
    h = mix(h ^ std::bit_cast<std::uint64_t>(p.y + 0.0));
  }
  return h;
}

}  // namespace

std::uint64_t mesh_digest(const MeshPiece& mesh) {
  std::uint64_t sum = 0;
  const auto point = [&](std::int32_t i) { return &mesh.points[static_cast<std::size_t>(i)]; };
  for (const auto& [a, b, c] : mesh.triangles) sum += triangle_digest({point(a), point(b), point(c)});
  return sum;
}

std::uint64_t mesh_digest(const Triangulation& mesh) {
  std::uint64_t sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.triangles[t].alive()) continue;
    const auto id = static_cast<TriangleId>(t);
    sum += triangle_digest({&mesh.corner(id, 0), &mesh.corner(id, 1), &mesh.corner(id, 2)});
  }
  return sum;
}

}  // namespace driftmesh
