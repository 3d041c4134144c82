#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/findings.hpp"
#include "verify/number_runs.hpp"
#include "verify/piece_check.hpp"

namespace driftmesh {

/// The numbers of points in all pieces.
class PieceNumbers {
 public:
  explicit PieceNumbers(std::span<const PieceReport> pieces);

  /// The numbers, ascending, of points that are inside one piece and in another one, too: only faulty pieces have such.
  [[nodiscard]] std::vector<std::int64_t> shared() const { return all_.repeated(); }
  /// How many points the whole mesh has.
  [[nodiscard]] std::size_t points() const { return too_large_ ? all_.count() : all_.largest() + 1; }
  /// Adds a flaw if numbers go far beyond the number of points.
  void check_largest(Findings& findings) const;
  /// Adds the numbers that no piece has.
  void check_gaps(Findings& findings) const;

 private:
  NumberRuns all_;
  bool too_large_ = false;
};

}  // namespace driftmesh
