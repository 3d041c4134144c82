#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <span>
#include <vector>

#include "decompose/cut_finder.hpp"
#include "decompose/decompose.hpp"
#include "decompose/pieces.hpp"
#include "decompose/planar_map.hpp"
#include "decompose/work_samples.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// Cuts pieces until each is one subdomain, those with the most parts first.
class Cutter {
 public:
  /// `samples`: of each piece, all empty where work is in proportion to area. `parts`: of all pieces outside bundles.
  Cutter(PlanarMap& map, IdVector<PieceId, Piece>& pieces, IdVector<PieceId, WorkSamples>& samples,
         const DecomposeOptions& options, std::int32_t parts);

  /// Returns the number of parts that could not be made.
  [[nodiscard]] std::int32_t run();

  /// Cuts each finished piece of more than `work` in two, or in three where that leaves less on every side, if it can
  /// be cut. This makes more pieces than parts.
  void divide(double work);

 private:
  void enqueue(PieceId piece);
  void cut_all(std::span<const PieceId> pieces);
  void give_up(PieceId piece);
  void spend_spare_parts();
  [[nodiscard]] FoundCut find(PieceId piece, double bias);
  [[nodiscard]] double random_bias();
  [[nodiscard]] bool cut(PieceId piece, const FoundCut& found);
  [[nodiscard]] bool cut_in_three(PieceId piece);
  [[nodiscard]] Piece part_of(const Piece& whole, SideId side);
  void share_samples(PieceId rest, PieceId between);

  PlanarMap& map_;
  IdVector<PieceId, Piece>& pieces_;
  IdVector<PieceId, WorkSamples>& samples_;
  double mean_ = 0;
  double skew_;
  std::mt19937_64 random_;
  std::map<std::int32_t, std::vector<PieceId>, std::greater<>> queue_;  // pieces by their number of parts
  std::int32_t spare_ = 0;
  CutFinder finder_;
  Loop loop_;
};

}  // namespace driftmesh
