#pragma once

#include <memory>

#include "job/on_ranks.hpp"
#include "job/simulated/simulated_ranks.hpp"

namespace driftmesh::pdr {

/// The ranks of a team, which make a mesh by partially coupled refinement instead of in subdomains.
class LatticeOnRanks final : public job::OnRanks {
 public:
  explicit LatticeOnRanks(job::Team& team) : OnRanks(team, nullptr) {}

  [[nodiscard]] job::Cut cut(const job::Request& /*request*/) const override { return job::Cut::kNever; }
  [[nodiscard]] std::unique_ptr<job::Refined> refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* size, job::Watch& watch) override;
};

/// The same in virtual time. A point costs what it costs subdomains on each rank that inserts it: at the start, which
/// every rank makes for itself, in its own cells, and where it repeats what others did. Where triangles stand for many
/// (ClusterSpec::scale), the start far from a rank's cells costs that much less: the same lattice would do for all.
class SimulatedLattice final : public job::SimulatedRanks {
 public:
  using SimulatedRanks::SimulatedRanks;

  [[nodiscard]] job::Cut cut(const job::Request& /*request*/) const override { return job::Cut::kNever; }
  [[nodiscard]] std::unique_ptr<job::Refined> refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* size, job::Watch& watch) override;
};

}  // namespace driftmesh::pdr
