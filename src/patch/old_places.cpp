#include "patch/old_places.hpp"

#include <algorithm>
#include <bit>

#include "driftmesh/id_vector.hpp"

namespace driftmesh::patch {
namespace {

std::size_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = a * 0x9e3779b97f4a7c15 + b;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93;
  return h ^ (h >> 32);
}

/// Equal for both zeros.
std::size_t hash_of(const Point& p) {
  return mixed(mixed(0, std::bit_cast<std::uint64_t>(p.x + 0.0)), std::bit_cast<std::uint64_t>(p.y + 0.0));
}

std::array<std::int32_t, 3> ascending(std::array<std::int32_t, 3> points) {
  std::ranges::sort(points);
  return points;
}

}  // namespace

OldPlaces::Table::Table(std::size_t count) : slots_(std::bit_ceil(2 * count + 1), -1) {}

template <class IsTheOne>
std::size_t OldPlaces::Table::slot(std::size_t hash, const IsTheOne& is_the_one) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] >= 0 && !is_the_one(to_index(slots_[slot]))) slot = (slot + 1) & mask;
  return slot;
}

std::size_t OldPlaces::slot_of(const Point& p) const {
  return points_.slot(hash_of(p), [&](std::size_t v) { return mesh_.points[v] == p; });
}

std::size_t OldPlaces::slot_of(const std::array<std::int32_t, 3>& points) const {
  const auto word = [&](std::size_t i) { return static_cast<std::uint64_t>(points[i]); };
  return triangles_.slot(mixed(mixed(word(0), word(1)), word(2)),
                         [&](std::size_t t) { return ascending(mesh_.triangles[t]) == points; });
}

OldPlaces::OldPlaces(const Mesh& mesh) : mesh_(mesh), points_(mesh.points.size()), triangles_(mesh.triangles.size()) {
  const auto enter = [](std::int32_t& slot, std::size_t number) {
    if (slot < 0) slot = static_cast<std::int32_t>(number);
  };
  for (std::size_t v = 0; v < mesh.points.size(); ++v) enter(points_[slot_of(mesh.points[v])], v);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) enter(triangles_[slot_of(ascending(mesh.triangles[t]))], t);
}

std::int32_t OldPlaces::point_at(const Point& p) const {
  return points_[slot_of(p)];
}

std::int32_t OldPlaces::triangle_of(std::array<std::int32_t, 3> points) const {
  return triangles_[slot_of(ascending(points))];
}

}  // namespace driftmesh::patch
