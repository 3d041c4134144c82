#include "adapt/generation.hpp"

#include <utility>

#include "distributed/assembly.hpp"
#include "distributed/exchange.hpp"

namespace driftmesh::adapt {

Generation assemble(const Decomposition& decomposition, const Pslg& pslg, Parts parts) {
  Generation made{std::move(parts), {}, {}, {}};
  const HeldSubdomains held = [&](const ShowSubdomain& show) {
    for (const SubdomainId s : ids_of(made.parts)) show(s, *made.parts[s].mesh);
  };
  PieceAssembly assembly(Rank{0}, 1, decomposition, held);
  const IdVector<Rank, Exchange*> alone{&assembly};
  exchange_directly(alone);
  PiecePlaces places;
  made.piece = assembly.piece(pslg, &places);
  std::int32_t triangles = 0;
  for (const SubdomainId s : ids_of(made.parts)) {
    made.places.push_back(std::move(places.at(s)));
    made.first_triangle.push_back(triangles);
    triangles += static_cast<std::int32_t>(made.parts[s].mesh->mesh.live_triangles());
  }
  return made;
}

}  // namespace driftmesh::adapt
