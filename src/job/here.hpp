#pragma once

#include <cstdint>
#include <memory>

#include "job/place.hpp"

namespace driftmesh::job {

/// This process alone: the mesh is made in one piece, or in subdomains on its threads.
class Here final : public Place {
 public:
  /// `kind`: kOnePiece, where large meshes are cut nevertheless if the request lets them, or kSubdomains.
  Here(PlaceKind kind, std::int32_t threads) : kind_(kind), threads_(threads) {}

  [[nodiscard]] PlaceKind kind() const override { return kind_; }
  [[nodiscard]] std::int32_t ranks() const override { return threads_; }
  [[nodiscard]] Cut cut(const Request& request) const override;
  [[nodiscard]] IdVector<Rank, double> speeds(const Request& request) const override;
  /// Depends on the decomposition alone (distributed/piece_series.hpp).
  [[nodiscard]] std::int32_t pieces(const Decomposition& decomposition) const override;
  [[nodiscard]] std::unique_ptr<Refined> refine(Order&& order, const Limits& limits, const SizeField* size,
                                                Watch& watch) override;

 private:
  PlaceKind kind_;
  std::int32_t threads_;
};

/// The number of threads that a request asks for: by default one for each core that this process may use.
[[nodiscard]] std::int32_t threads_of(const Request& request);

}  // namespace driftmesh::job
