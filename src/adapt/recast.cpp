#include "adapt/recast.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace driftmesh::adapt {
namespace {

/// What vertices and triangles were in the part that a changed one is taken from.
struct Former {
  IdVector<VertexId, VertexId> vertex;
  IdVector<TriangleId, TriangleId> triangle;
};

bool has_chain(const SubdomainMesh& part, const RenamedRoots& renamed) {
  return std::any_of(part.roots.begin(), part.roots.end(), [&](GlobalRootId r) { return renamed.contains(r); });
}

/// `mesh` is taken from that of the whole.
Part part_of(const Part& whole, SubdomainMesh mesh, const Former& former) {
  Part part{.mesh = std::make_shared<const SubdomainMesh>(std::move(mesh)), .density = whole.density};
  part.asked = whole.asked * static_cast<double>(former.triangle.size()) /
               static_cast<double>(whole.mesh->mesh.live_triangles());
  if (!whole.made_for) return part;
  Lengths lengths;
  for (const VertexId v : former.vertex) lengths.push_back((*whole.made_for)[v]);
  part.made_for = std::make_shared<const Lengths>(std::move(lengths));
  return part;
}

/// The parts of this rank, and for those that changed what they consist of.
std::pair<Parts, std::map<SubdomainId, Former>> recast_parts(const Parts& present, const RenamedRoots& renamed,
                                                             const Decomposition& now,
                                                             const IdVector<SubdomainId, SubdomainId>& whole_of) {
  IdVector<SubdomainId, int> children(present.size(), 0);
  for (const SubdomainId p : whole_of) ++children[p];
  Parts parts(now.size());
  std::map<SubdomainId, Former> formers;
  for (const SubdomainId s : ids_of(parts)) {
    const Part& whole = present[whole_of[s]];
    if (!whole.mesh) continue;
    if (children[whole_of[s]] == 1 && !has_chain(*whole.mesh, renamed)) {
      parts[s] = whole;
      continue;
    }
    ExtractedSubdomain extracted = extract_subdomain(*whole.mesh, renamed, now, s);
    Former& former = formers[s] = {std::move(extracted.vertex), std::move(extracted.triangle)};
    parts[s] = part_of(whole, std::move(extracted.part), former);
  }
  return {std::move(parts), std::move(formers)};
}

/// For each point and triangle of this rank's piece, which it was in the piece before.
struct Renumbering {
  std::vector<std::int32_t> points, triangles;
};

Renumbering renumbering(const Generation& before, const Generation& after,
                        const IdVector<SubdomainId, SubdomainId>& whole_of,
                        const std::map<SubdomainId, Former>& formers) {
  Renumbering old{std::vector<std::int32_t>(after.piece.mesh.points.size(), -1), {}};
  old.triangles.reserve(after.piece.mesh.triangles.size());
  for (const SubdomainId s : after.here) {
    const SubdomainId p = whole_of[s];
    const auto former = formers.find(s);
    const bool kept = former == formers.end();
    for (const VertexId v : ids_of(after.places[s]))
      if (after.places[s][v] != kNone)
        old.points[to_index(after.places[s][v])] = before.places[p][kept ? v : former->second.vertex[v]];
    const Triangulation& mesh = before.parts[p].mesh->mesh;
    IdVector<TriangleId, std::int32_t> place(mesh.triangles.size(), kNone);
    std::int32_t next_place = before.first_triangle[p];
    for (const TriangleId t : ids_of(mesh.triangles))
      if (mesh.triangles[t].alive()) {
        place[t] = next_place++;
        if (kept) old.triangles.push_back(place[t]);
      }
    if (!kept)
      for (const TriangleId t : former->second.triangle) old.triangles.push_back(place[t]);
  }
  return old;
}

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

Parts recast(const Parts& present, const RenamedRoots& renamed, const Decomposition& now,
             const IdVector<SubdomainId, SubdomainId>& whole_of) {
  return recast_parts(present, renamed, now, whole_of).first;
}

Holding recast(const Holding& present, const RenamedRoots& renamed, const Decomposition& now,
               const IdVector<SubdomainId, SubdomainId>& whole_of, const std::function<Generation(Parts)>& assemble,
               Ranks& ranks) {
  Parts parts;
  std::map<SubdomainId, Former> formers;
  ranks.agree([&] { std::tie(parts, formers) = recast_parts(present.generation.parts, renamed, now, whole_of); });
  Holding next{assemble(std::move(parts)), {}, {}, {}};
  const Renumbering old = renumbering(present.generation, next.generation, whole_of, formers);
  for (const auto& [name, field] : present.fields) {
    const bool at_points = field.place == FieldPlace::kPoints;
    const std::size_t each = (field.place == FieldPlace::kCorners ? 3 : 1) * field.components;
    next.fields[name] = {field.place, field.how, field.components,
                         reordered(field.values, at_points ? old.points : old.triangles, each)};
  }
  next.stayed_points = reordered(present.stayed_points, old.points, 1);
  next.stayed_triangles = reordered(present.stayed_triangles, old.triangles, 1);
  return next;
}

}  // namespace driftmesh::adapt
