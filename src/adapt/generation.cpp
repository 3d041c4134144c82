#include "adapt/generation.hpp"

#include <utility>

#include "adapt/demand.hpp"
#include "distributed/assembly.hpp"

namespace driftmesh::adapt {

IdVector<TriangleId, std::int32_t> numbers_of_triangles(const Generation& generation, SubdomainId s) {
  const Triangulation& mesh = generation.parts[s].mesh->mesh;
  IdVector<TriangleId, std::int32_t> numbers(mesh.triangles.size(), kNone);
  std::int32_t next = generation.first_triangle[s];
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) numbers[t] = next++;
  return numbers;
}

Part first_part(SubdomainMesh mesh, const QualityBounds& bounds, Lengths made_for) {
  Part part{.mesh = std::make_shared<const SubdomainMesh>(std::move(mesh))};
  part.asked = demand_of(part.mesh->mesh, bounds, made_for).triangles;
  if (part.asked > 0) part.density = static_cast<double>(part.mesh->mesh.live_triangles()) / part.asked;
  if (!made_for.empty()) part.made_for = std::make_shared<const Lengths>(std::move(made_for));
  return part;
}

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
