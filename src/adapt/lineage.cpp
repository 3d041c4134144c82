#include "adapt/lineage.hpp"

#include "base/in_turns.hpp"

namespace driftmesh::adapt {
namespace {

/// The number of each triangle in the piece; kNone for free slots.
IdVector<TriangleId, std::int32_t> numbers_of_triangles(const Triangulation& mesh, std::int32_t first) {
  IdVector<TriangleId, std::int32_t> numbers(mesh.triangles.size(), kNone);
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) numbers[t] = first++;
  return numbers;
}

}  // namespace

Lineage::Lineage(const Generation& before, const Generation& after, std::int32_t threads)
    : before_(before),
      after_(after),
      threads_(threads),
      descents_(after.parts.size()),
      owner_(after.piece.mesh.points.size(), kNoSubdomain) {
  for_each_part([&](SubdomainId s) {
    if (!is_the_same(s)) descents_[s] = trace(before.parts[s].mesh->mesh, after.parts[s].mesh->mesh);
  });
  for (const SubdomainId s : ids_of(after.places))
    for (const std::int32_t place : after.places[s])
      if (place != kNone && owner_[to_index(place)] == kNoSubdomain) owner_[to_index(place)] = s;
}

void Lineage::for_each_part(const std::function<void(SubdomainId)>& work) const {
  in_turns(after_.parts.size(), to_index(threads_), [&](std::size_t s) { work(static_cast<SubdomainId>(s)); });
}

void Lineage::visit_points(const std::function<void(std::int32_t, const Source&)>& visit) const {
  for_each_part([&](SubdomainId s) {
    const IdVector<VertexId, std::int32_t>&old = before_.places[s], &places = after_.places[s];
    for (const VertexId v : ids_of(places)) {
      if (places[v] == kNone || owner_[to_index(places[v])] != s) continue;
      if (is_the_same(s)) {
        visit(places[v], {{old[v], old[v], old[v]}, {1, 0, 0}, true});
        continue;
      }
      const Descent::Source& from = descents_[s].sources[v];
      visit(places[v], {{old[from.vertex[0]], old[from.vertex[1]], old[from.vertex[2]]}, from.weight, from.stays});
    }
  });
}

std::vector<std::int32_t> Lineage::stayed_points() const {
  std::vector<std::int32_t> stayed(after_.piece.mesh.points.size(), -1);
  visit_points([&](std::int32_t point, const Source& from) {
    if (from.stays) stayed[to_index(point)] = from.point[0];
  });
  return stayed;
}

std::vector<std::int32_t> Lineage::stayed_triangles() const {
  std::vector<std::int32_t> stayed(after_.piece.mesh.triangles.size(), -1);
  for_each_part([&](SubdomainId s) {
    const Triangulation& mesh = after_.parts[s].mesh->mesh;
    const auto old = numbers_of_triangles(before_.parts[s].mesh->mesh, before_.first_triangle[s]);
    std::int32_t number = after_.first_triangle[s];
    for (const TriangleId t : ids_of(mesh.triangles)) {
      if (!mesh.triangles[t].alive()) continue;
      const TriangleId from = is_the_same(s) ? t : descents_[s].same[t];
      if (from != kNone) stayed[to_index(number)] = old[from];
      ++number;
    }
  });
  return stayed;
}

}  // namespace driftmesh::adapt
