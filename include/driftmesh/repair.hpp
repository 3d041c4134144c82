#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// One kind of repair: its count, and the first few cases described with the numbers of the file.
struct RepairItem {
  static constexpr std::int64_t kMaxExamples = 3;
  std::int64_t count = 0;
  std::vector<std::string> examples;
};

/// What repair() does beyond what a mesh needs.
struct RepairOptions {
  /// Joins what is at most this far apart: vertices to vertices, and segments to vertices. 0: only what is within
  /// rounding error. Not negative, finite.
  double snap = 0;
  /// Adds the edges of the convex hull of all points as segments, with marker 1 where there is no segment yet. An
  /// InputError with polygons, which say themselves what the domain is.
  bool hull = false;
};

/// What repair() changed in a Pslg.
struct RepairReport {
  RepairItem rounded_points;          ///< coordinates below 7.5e-37 rounded to multiples of 2^-172 (1.7e-52)
  RepairItem duplicate_points;        ///< equal to an earlier one, merged into it
  RepairItem close_points;            ///< within rounding error of an earlier one, merged into it
  RepairItem zero_length_segments;    ///< dropped
  RepairItem duplicate_segments;      ///< dropped
  RepairItem points_on_segments;      ///< segments split at a vertex in their interior
  RepairItem points_close_segments;   ///< segments bent to pass through a vertex within rounding error of them
  RepairItem crossings;               ///< both segments split at a new vertex
  RepairItem overlaps;                ///< pieces that two overlapping segments share, kept once
  RepairItem collapsed;               ///< pieces of rings dropped since snapping left no area between them
  RepairItem marker_conflicts;        ///< merged segments with different markers; the first marker is kept
  double snap = 0;                    ///< the length by which close points and segments were judged; 0: rounding error
  double largest_move = 0;            ///< farthest that a merged point or a bent segment moved
  std::vector<std::string> warnings;  ///< left unchanged, but possibly unintended

  /// For each point of the result, its index in the input; -1 for a new one.
  std::vector<std::int32_t> original_point;

  /// Whether repair() changed anything.
  [[nodiscard]] bool changed() const;
  /// One line for each kind of repair that was made, with examples, and one for each of the first warnings; empty if
  /// there are none.
  [[nodiscard]] std::string summary() const;
};

/// Makes `pslg` planar and reports what was changed. Afterward, decided by exact predicates:
/// - no two points are equal, or within rounding error of each other (a few units in the last place);
/// - no segment has length zero, no two join the same points;
/// - no point lies in the interior of a segment, or within rounding error of it;
/// - no two segments meet except at a common endpoint;
/// - corners of rings that follow each other are different, and the ends of a segment. A ring may have none left.
/// Points without segments get the edges of their convex hull as segments with marker 1, which counts as no change; so
/// do others if options.hull is set.
///
/// With options.snap, points are merged if they are that near, each into the nearest of those before it, and segments
/// are bent to pass through points that near. So no point moves by more than options.snap, no two of the result are
/// nearer to each other, and a point nearer to a segment is beside an end of it. What is left of rings without area
/// between their sides is dropped.
///
/// A Pslg with these properties is left as it is, so a second repair changes nothing.
/// Points, holes and regions keep their order, and so do segments and their pieces. New points lie where segments
/// crossed; they take the marker of the first of the two segments, and their attributes are interpolated along it.
///
/// Seeds of holes and regions that are certainly outside are reported as warnings. Throws InputError, naming `file`, if
/// the intent is not clear: indices or coordinates out of range, edges of rings that are no segments, fewer than three
/// points or all on one line, a seed on a segment, more than kMaxSplits places where segments must be split, or
/// crossings that rounding creates anew in each of kMaxRounds rounds (seen only where a fuzzer put long segments a few
/// units in the last place apart).
///
/// \code
/// driftmesh::Pslg cross;
/// cross.points = {{0, 0}, {1, 1}, {0, 1}, {1, 0}};
/// cross.segments = {{0, 1}, {2, 3}};
/// const driftmesh::RepairReport report = driftmesh::repair(cross, "cross");
/// assert(report.crossings.count == 1 && cross.points.size() == 5);
/// std::cout << report.summary();
/// \endcode
RepairReport repair(Pslg& pslg, const std::string& file = "input", const RepairOptions& options = {});

inline constexpr std::int64_t kMaxSplits = 20'000'000;
inline constexpr int kMaxRounds = 40;

}  // namespace driftmesh
