#include "adapt/lineage.hpp"

#include <algorithm>

#include "adapt/shared_points.hpp"
#include "base/in_turns.hpp"

namespace driftmesh::adapt {

Lineage::Lineage(const Generation& before, const Generation& after, std::int32_t threads, Ranks& ranks)
    : before_(before),
      after_(after),
      threads_(threads),
      ranks_(ranks),
      lowest_here_(after.piece.mesh.points.size(), kNoSubdomain) {
  for (const SubdomainId s : after.here)
    for (const std::int32_t place : after.places[s])
      if (place != kNone && lowest_here_[to_index(place)] == kNoSubdomain) lowest_here_[to_index(place)] = s;
  lowest_ = lowest_here_;
  tell_at_shared_points(
      ranks, after.piece, [&](std::int32_t point, ByteWriter& writer) { writer.value(lowest_here_[to_index(point)]); },
      [&](std::int32_t point, ByteReader& reader, Rank /*from*/) {
        SubdomainId& lowest = lowest_[to_index(point)];
        lowest = std::min(lowest, reader.value<SubdomainId>());
      });
}

void Lineage::settle_shared(std::vector<double>& values, std::size_t components) const {
  const auto at = [&](std::int32_t point) { return values.begin() + to_index(point) * components; };
  tell_at_shared_points(
      ranks_, after_.piece,
      [&](std::int32_t point, ByteWriter& writer) {
        std::for_each_n(at(point), components, [&](double value) { writer.value(value); });
      },
      [&](std::int32_t point, ByteReader& reader, Rank from) {
        const bool counts = after_.holders[lowest_at(point)] == from;
        std::for_each_n(at(point), components, [&](double& value) {
          const auto theirs = reader.value<double>();
          if (counts) value = theirs;
        });
      });
}

void Lineage::visit_parts(const std::function<void(const Change&)>& visit) const {
  in_turns(after_.here.size(), to_index(threads_), [&](std::size_t i) {
    const SubdomainId s = after_.here[i];
    const bool is_the_same = before_.parts[s].mesh == after_.parts[s].mesh;
    const Triangulation &old_mesh = before_.parts[s].mesh->mesh, &new_mesh = after_.parts[s].mesh->mesh;
    const Descent descent = is_the_same ? Descent() : trace(old_mesh, new_mesh);
    visit({s, is_the_same, old_mesh, new_mesh, descent, numbers_of_triangles(before_, s),
           numbers_of_triangles(after_, s), before_.places[s], after_.places[s]});
  });
}

void Lineage::visit_points(const Change& change, const std::function<void(std::int32_t, const Source&)>& visit) const {
  const IdVector<VertexId, std::int32_t>&old = change.old_place, &places = change.new_place;
  for (const VertexId v : ids_of(places)) {
    if (places[v] == kNone || lowest_here_[to_index(places[v])] != change.subdomain) continue;
    if (change.is_the_same) {
      visit(places[v], {{old[v], old[v], old[v]}, {1, 0, 0}, true});
      continue;
    }
    const Descent::Source& from = change.descent.sources[v];
    visit(places[v], {{old[from.vertex[0]], old[from.vertex[1]], old[from.vertex[2]]}, from.weight, from.stays});
  }
}

void visit_same_triangles(const Lineage::Change& change,
                          const std::function<void(std::int32_t, std::int32_t, int)>& visit) {
  for (const TriangleId t : ids_of(change.new_number)) {
    if (change.new_number[t] == kNone || !change.stays(t)) continue;
    const TriangleId from = change.is_the_same ? t : change.descent.same[t];
    const VertexId v = change.new_mesh.triangles[t].vertex[0];
    const VertexId first = change.is_the_same ? v : change.descent.sources[v].vertex[0];
    const auto& corners = change.old_mesh.triangles[from].vertex;
    visit(change.new_number[t], change.old_number[from], corners[0] == first ? 0 : corners[1] == first ? 1 : 2);
  }
}

}  // namespace driftmesh::adapt
