#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace driftmesh {

/// One kind of repair: how often it was made, and the first few in words with the numbers that the file uses.
struct RepairItem {
  static constexpr std::int64_t kMaxExamples = 3;
  std::int64_t count = 0;
  std::vector<std::string> examples;
};

/// What repair() changed in a Pslg.
struct RepairReport {
  RepairItem duplicate_points;        ///< equal to an earlier one, merged into it
  RepairItem close_points;            ///< within rounding error of an earlier one, merged into it
  RepairItem zero_length_segments;    ///< dropped
  RepairItem duplicate_segments;      ///< dropped
  RepairItem points_on_segments;      ///< segments split at a vertex in their interior
  RepairItem points_close_segments;   ///< segments bent to pass through a vertex within rounding error of them
  RepairItem crossings;               ///< both segments split at a new vertex
  RepairItem overlaps;                ///< pieces that two overlapping segments share, kept once
  RepairItem marker_conflicts;        ///< merged segments with different markers; the first marker is kept
  std::vector<std::string> warnings;  ///< what was left unchanged but may be unintended

  /// For each point of the result, its index in the input; -1 for a new one.
  std::vector<std::int32_t> original_point;

  /// Whether repair() changed anything.
  [[nodiscard]] bool changed() const;
  /// One line for each kind of repair that was made, with examples, and one for each of the first warnings; empty if
  /// there are none.
  [[nodiscard]] std::string summary() const;
};

}  // namespace driftmesh
