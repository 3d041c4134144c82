#include "adapt/generation.hpp"

#include <utility>

#include "distributed/assembly.hpp"

namespace driftmesh::adapt {

Generation assemble(const Decomposition& decomposition, const Pslg& pslg, Parts parts, Ranks& ranks) {
  Generation made;
  made.parts = std::move(parts);
  for (const SubdomainId s : ids_of(made.parts))
    if (made.is_here(s)) made.here.push_back(s);
  const HeldSubdomains held = [&](const ShowSubdomain& show) {
    for (const SubdomainId s : made.here) show(s, *made.parts[s].mesh);
  };
  PieceAssembly assembly(ranks.rank(), ranks.ranks(), decomposition, held);
  ranks.run(assembly);
  PiecePlaces places;
  made.piece = assembly.piece(pslg, &places);
  made.holders = assembly.subdomains().rank;
  made.places.resize(made.parts.size());
  made.first_triangle.resize(made.parts.size());
  std::int32_t triangles = 0;
  for (const SubdomainId s : made.here) {
    made.places[s] = std::move(places.at(s));
    made.first_triangle[s] = triangles;
    triangles += static_cast<std::int32_t>(made.parts[s].mesh->mesh.live_triangles());
  }
  return made;
}

}  // namespace driftmesh::adapt
