#include "adapt/renumber.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace driftmesh::adapt {
namespace {

/// For each point and triangle of a piece, which it was in the piece before.
class Renumbering {
 public:
  Renumbering(const Generation& before, const Generation& after, const IdVector<SubdomainId, Former>& former)
      : before_(before), after_(after), points_(after.piece.mesh.points.size(), kNone) {
    triangles_.reserve(after.piece.mesh.triangles.size());
    for (const SubdomainId s : after.here) {
      find_points(s, former[s]);
      find_triangles(former[s]);
    }
  }
  [[nodiscard]] const std::vector<std::int32_t>& points() const { return points_; }
  [[nodiscard]] const std::vector<std::int32_t>& triangles() const { return triangles_; }

 private:
  void find_points(SubdomainId s, const Former& former) {
    for (const VertexId v : ids_of(after_.places[s])) {
      const std::int32_t place = after_.places[s][v];
      if (place == kNone) continue;
      const InMesh<VertexId> was = former.vertex.empty() ? InMesh<VertexId>{0, v} : former.vertex[v];
      points_[to_index(place)] = before_.places[former.parts[to_index(was.mesh)]][was.id];
    }
  }

  void find_triangles(const Former& former) {
    if (former.triangle.empty()) {
      const SubdomainId p = former.parts.front();
      const auto count = static_cast<std::int32_t>(before_.parts[p].mesh->mesh.live_triangles());
      for (std::int32_t i = 0; i < count; ++i) triangles_.push_back(before_.first_triangle[p] + i);
      return;
    }
    std::vector<IdVector<TriangleId, std::int32_t>> number;
    for (const SubdomainId p : former.parts) number.push_back(numbers_of_triangles(before_, p));
    for (const auto& [mesh, id] : former.triangle) triangles_.push_back(number[to_index(mesh)][id]);
  }

  const Generation& before_;
  const Generation& after_;
  std::vector<std::int32_t> points_, triangles_;
};

/// `each` values for each place, in another order.
template <class T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<std::int32_t>& old, std::size_t each) {
  std::vector<T> all;
  if (values.empty()) return all;
  all.reserve(old.size() * each);
  for (const std::int32_t place : old) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(to_index(place) * each);
    all.insert(all.end(), first, first + static_cast<std::ptrdiff_t>(each));
  }
  return all;
}

}  // namespace

Holding renumbered(const Held& present, Generation now, const IdVector<SubdomainId, Former>& former) {
  Holding next{std::move(now), {}, {}};
  const Renumbering old(present.generation, next.generation, former);
  for (const auto& [name, field] : present.fields) {
    const bool at_points = field.place == FieldPlace::kPoints;
    next.fields[name] = {field.place, field.how, field.components,
                         reordered(field.values, at_points ? old.points() : old.triangles(), values_at(field))};
  }
  next.stayed = {reordered(present.stayed.points, old.points(), 1),
                 reordered(present.stayed.triangles, old.triangles(), 1)};
  return next;
}

}  // namespace driftmesh::adapt
