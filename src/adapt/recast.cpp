#include "adapt/recast.hpp"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

#include "adapt/renumber.hpp"

namespace driftmesh::adapt {
namespace {

bool has_chain(const SubdomainMesh& part, const RenamedRoots& renamed) {
  return std::any_of(part.roots.begin(), part.roots.end(), [&](GlobalRootId r) { return renamed.contains(r); });
}

Part part_of(const Part& whole, ExtractedSubdomain extracted) {
  Part part{.mesh = std::make_shared<const SubdomainMesh>(std::move(extracted.part)), .density = whole.density};
  part.asked = whole.asked * static_cast<double>(extracted.triangle.size()) /
               static_cast<double>(whole.mesh->mesh.live_triangles());
  if (!whole.made_for) return part;
  Lengths lengths;
  for (const VertexId v : extracted.vertex) lengths.push_back((*whole.made_for)[v]);
  part.made_for = std::make_shared<const Lengths>(std::move(lengths));
  return part;
}

Former former_of(SubdomainId whole, const ExtractedSubdomain& extracted) {
  Former former{.parts = {whole}};
  for (const VertexId v : extracted.vertex) former.vertex.push_back({0, v});
  for (const TriangleId t : extracted.triangle) former.triangle.push_back({0, t});
  return former;
}

/// The parts of this rank, and what they consist of.
std::pair<Parts, IdVector<SubdomainId, Former>> recast_parts(const Parts& present, const RenamedRoots& renamed,
                                                             const Decomposition& now,
                                                             const IdVector<SubdomainId, SubdomainId>& whole_of) {
  IdVector<SubdomainId, int> children(present.size(), 0);
  for (const SubdomainId p : whole_of) ++children[p];
  Parts parts(now.size());
  IdVector<SubdomainId, Former> formers(now.size());
  for (const SubdomainId s : ids_of(parts)) {
    const Part& whole = present[whole_of[s]];
    if (!whole.mesh) continue;
    if (children[whole_of[s]] == 1 && !has_chain(*whole.mesh, renamed)) {
      parts[s] = whole;
      formers[s] = {.parts = {whole_of[s]}};
      continue;
    }
    ExtractedSubdomain extracted = extract_subdomain(*whole.mesh, renamed, now, s);
    formers[s] = former_of(whole_of[s], extracted);
    parts[s] = part_of(whole, std::move(extracted));
  }
  return {std::move(parts), std::move(formers)};
}

}  // namespace

Parts recast(const Parts& present, const RenamedRoots& renamed, const Decomposition& now,
             const IdVector<SubdomainId, SubdomainId>& whole_of) {
  return recast_parts(present, renamed, now, whole_of).first;
}

Holding recast(const Held& present, const RenamedRoots& renamed, const Decomposition& now,
               const IdVector<SubdomainId, SubdomainId>& whole_of, const std::function<Generation(Parts)>& assemble,
               Ranks& ranks) {
  Parts parts;
  IdVector<SubdomainId, Former> formers;
  ranks.agree([&] { std::tie(parts, formers) = recast_parts(present.generation.parts, renamed, now, whole_of); });
  return renumbered(present, assemble(std::move(parts)), formers);
}

}  // namespace driftmesh::adapt
