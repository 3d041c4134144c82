#include "patch/neighborhood.hpp"

#include <algorithm>
#include <utility>

#include "driftmesh/id_vector.hpp"

namespace driftmesh::patch {

Neighborhood::Neighborhood(const Mesh& mesh, const std::vector<bool>& inside)
    : mesh_(mesh), taken_(inside.begin(), inside.end()) {}

bool Neighborhood::touches(std::size_t triangle, const std::vector<std::uint8_t>& marked) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return (marked[to_index(a)] | marked[to_index(b)] | marked[to_index(c)]) != 0;
}

std::vector<std::uint8_t> Neighborhood::points_of_taken() const {
  std::vector<std::uint8_t> marked(mesh_.points.size(), 0);
  for (std::size_t t = 0; t < taken_.size(); ++t)
    if (taken_[t] != 0)
      for (const std::int32_t v : mesh_.triangles[t]) marked[to_index(v)] = 1;
  return marked;
}

bool Neighborhood::take_at(std::vector<std::uint8_t> marked, int layers) {
  if (std::ranges::find(taken_, 0) == taken_.end()) return false;
  bool any = false;
  std::vector<std::size_t> found;
  for (int layer = 0; layer < layers; ++layer) {
    found.clear();
    for (std::size_t t = 0; t < taken_.size(); ++t)
      if (touches(t, marked)) found.push_back(t);
    for (const std::size_t t : found) {
      any = any || taken_[t] == 0;
      taken_[t] = 1;
      for (const std::int32_t v : mesh_.triangles[t]) marked[to_index(v)] = 1;
    }
  }
  return any;
}

void Neighborhood::grow(int layers) {
  take_at(points_of_taken(), layers);
}

bool Neighborhood::grow_around(std::span<const std::int32_t> points, int layers) {
  std::vector<std::uint8_t> marked(mesh_.points.size(), 0);
  for (const std::int32_t v : points) marked[to_index(v)] = 1;
  return take_at(std::move(marked), layers);
}

std::vector<std::int32_t> Neighborhood::with_rim() const {
  const std::vector<std::uint8_t> marked = points_of_taken();
  std::vector<std::int32_t> triangles;
  for (std::size_t t = 0; t < taken_.size(); ++t)
    if (touches(t, marked)) triangles.push_back(static_cast<std::int32_t>(t));
  return triangles;
}

}  // namespace driftmesh::patch
