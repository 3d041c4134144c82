#pragma once

#include <functional>
#include <memory>

#include "job/on_ranks.hpp"
#include "job/simulated/simulated_ranks.hpp"

namespace driftmesh::pdr {

/// The ranks of a team, which make a mesh by partially coupled refinement (src/pdr) instead of in subdomains.
class LatticeOnRanks final : public job::OnRanks {
 public:
  explicit LatticeOnRanks(job::Team& team) : OnRanks(team, nullptr) {}

  [[nodiscard]] job::Cut cut(const job::Request& /*request*/) const override { return job::Cut::kNever; }
  [[nodiscard]] job::Order share(const std::function<job::Order()>& make) override;
  /// Throws KeyError if nothing bounds the size of triangles.
  [[nodiscard]] std::unique_ptr<job::Refined> refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* size, job::Watch& watch) override;
};

/// The same in virtual time.
class SimulatedLattice final : public job::SimulatedRanks {
 public:
  using SimulatedRanks::SimulatedRanks;

  [[nodiscard]] job::Cut cut(const job::Request& /*request*/) const override { return job::Cut::kNever; }
  /// Throws KeyError if nothing bounds the size of triangles.
  [[nodiscard]] std::unique_ptr<job::Refined> refine(job::Order&& order, const job::Limits& limits,
                                                     const SizeField* size, job::Watch& watch) override;
};

}  // namespace driftmesh::pdr
