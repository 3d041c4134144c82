#pragma once

#include <string>

#include "pslg/pslg.hpp"
#include "pslg/repair_report.hpp"

namespace driftmesh {

/// Makes `pslg` planar and reports what was changed. Afterwards, decided by exact predicates:
/// - no two points are equal, or within rounding error of each other (closeness.hpp);
/// - no segment has length zero, no two join the same points;
/// - no point lies in the interior of a segment, or within rounding error of it;
/// - no two segments meet except at a point that is an end of both.
/// Points without segments get the edges of their convex hull as segments with marker 1, which counts as no change.
/// A Pslg with these properties is left as it is, so repairing twice changes nothing the second time.
/// Points, holes and regions keep their order, as do segments, cut into pieces. New points lie where segments crossed;
/// they take the marker of the first of the two segments, and their attributes are interpolated along it.
///
/// Seeds of holes and regions that are certainly outside are reported as warnings. Throws InputError, naming `file`, if
/// the intent is not clear: indices or coordinates out of range, fewer than three points or all on one line, a seed on
/// a segment, more than kMaxSplits places where segments must be split, or crossings that rounding creates anew in each
/// of kMaxRounds rounds (seen only where a fuzzer put long segments a few units in the last place apart).
RepairReport repair(Pslg& pslg, const std::string& file = "input");

inline constexpr std::int64_t kMaxSplits = 20'000'000;
inline constexpr int kMaxRounds = 40;

}  // namespace driftmesh
