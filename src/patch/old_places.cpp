#include "patch/old_places.hpp"

#include <algorithm>
#include <bit>
#include <functional>

namespace driftmesh::patch {
namespace {

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = a * 0x9e3779b97f4a7c15 + b;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93;
  return h ^ (h >> 32);
}

/// Equal for both zeros.
std::array<std::uint64_t, 2> bits_of(const Point& p) {
  return {std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0)};
}

}  // namespace

std::size_t OldPlaces::Hash::operator()(const std::array<std::uint64_t, 2>& key) const {
  return mixed(mixed(0, key[0]), key[1]);
}

std::size_t OldPlaces::Hash::operator()(const std::array<std::int32_t, 3>& key) const {
  const auto word = [&](std::size_t i) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(key[i])); };
  return mixed(mixed(word(0), word(1)), word(2));
}

OldPlaces::OldPlaces(const Mesh& mesh) {
  points_.reserve(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    points_.emplace(bits_of(mesh.points[v]), static_cast<std::int32_t>(v));
  triangles_.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::int32_t, 3> key = mesh.triangles[t];
    std::ranges::sort(key);
    triangles_.emplace(key, static_cast<std::int32_t>(t));
  }
}

std::int32_t OldPlaces::point_at(const Point& p) const {
  const auto found = points_.find(bits_of(p));
  return found == points_.end() ? -1 : found->second;
}

std::int32_t OldPlaces::triangle_of(std::array<std::int32_t, 3> points) const {
  std::ranges::sort(points);
  const auto found = triangles_.find(points);
  return found == triangles_.end() ? -1 : found->second;
}

}  // namespace driftmesh::patch
