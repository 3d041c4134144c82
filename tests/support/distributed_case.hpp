#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "decompose/decompose.hpp"
#include "distributed/assembly.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "oracles/random_pslg.hpp"
#include "support/refine_together.hpp"

namespace driftmesh::testing {

/// A refined mesh in subdomains, as a run on many ranks leaves it.
struct DistributedCase {
  Pslg input;
  QualityBounds bounds;
  Decomposition decomposition;
  IdVector<SubdomainId, SubdomainMesh> parts;

  DistributedCase(Pslg pslg, std::int32_t subdomains, const QualityBounds& asked) : input(std::move(pslg)) {
    bounds = asked;
    Triangulation mesh = triangulate(input);
    prepare_corners(mesh);
    DecomposeOptions options;
    options.subdomains = subdomains;
    decomposition = decompose(mesh, options);
    parts = refine_together(decomposition, bounds).parts;
  }

  [[nodiscard]] HeldSubdomains held_by(Rank rank, const IdVector<SubdomainId, Rank>& owners) const {
    return [this, rank, owners](const ShowSubdomain& show) {
      for (const SubdomainId i : ids_of(parts))
        if (owners[i] == rank) show(i, parts[i]);
    };
  }

  /// One assembly for each rank, before any message.
  [[nodiscard]] IdVector<Rank, std::unique_ptr<PieceAssembly>> assemblies(
      std::int32_t ranks, const IdVector<SubdomainId, Rank>& owners) const {
    IdVector<Rank, std::unique_ptr<PieceAssembly>> all;
    for (const Rank r : first_ids<Rank>(ranks))
      all.push_back(std::make_unique<PieceAssembly>(r, ranks, decomposition, held_by(r, owners)));
    return all;
  }

  /// The pieces of all ranks, which talk directly.
  [[nodiscard]] IdVector<Rank, DistributedPiece> pieces(std::int32_t ranks,
                                                        const IdVector<SubdomainId, Rank>& owners) const {
    const auto all = assemblies(ranks, owners);
    IdVector<Rank, Exchange*> exchanges;
    for (const auto& assembly : all) exchanges.push_back(assembly.get());
    exchange_directly(exchanges);
    IdVector<Rank, DistributedPiece> result;
    for (const auto& assembly : all) result.push_back(assembly->piece(input));
    return result;
  }
};

/// A random domain with small angles, holes, regions, some with markers and attributes of their points.
inline DistributedCase random_distributed_case(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Pslg input = oracles::make_random_pslg(seed, oracles::make_random_shape(seed)).input;
  if (seed % 2 == 0) {
    input.attributes_per_point = static_cast<std::int32_t>(1 + seed % 3);
    input.attributes.clear();
    for (std::size_t k = 0; k < input.points.size() * static_cast<std::size_t>(input.attributes_per_point); ++k)
      input.attributes.push_back(static_cast<double>(random() % 1000) / 7);
  }
  input.point_markers.clear();
  if (seed % 3 == 0)
    for (std::size_t v = 0; v < input.points.size(); ++v)
      input.point_markers.push_back(static_cast<std::int32_t>(random() % 5));
  repair(input);
  const Triangulation mesh = triangulate(input);
  double area = 0;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) {
      const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
      area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    }
  QualityBounds bounds;
  bounds.min_angle = 20;
  bounds.plain.area = area / 200;
  return {std::move(input), static_cast<std::int32_t>(1 + random() % 12), bounds};
}

inline IdVector<SubdomainId, Rank> random_owners(std::size_t subdomains, std::int32_t ranks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  IdVector<SubdomainId, Rank> owners;
  for (std::size_t i = 0; i < subdomains; ++i)
    owners.push_back(static_cast<Rank>(random() % static_cast<std::uint64_t>(ranks)));
  return owners;
}

inline std::vector<Mesh> meshes_of(const std::vector<DistributedPiece>& pieces) {
  std::vector<Mesh> meshes;
  for (const DistributedPiece& piece : pieces) meshes.push_back(piece.mesh);
  return meshes;
}

}  // namespace driftmesh::testing
