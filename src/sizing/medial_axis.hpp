#pragma once

#include <functional>
#include <vector>

#include "sizing/segment_distance.hpp"

namespace driftmesh {

/// The segments that bound a domain, which lies to the left of each.
using OutlineSegments = std::vector<SegmentDistance::Ends>;
/// Finds them for who needs them. Null: there is no domain.
using FindOutline = std::function<OutlineSegments()>;

/// A piece of a medial axis: a segment, or a point where its ends are equal.
struct AxisPiece {
  Point a, b;
  double radius;  ///< no point of the piece is nearer to the outline
};

/// The medial axis of a domain, where the outline lies on opposite sides: the points inside that have two nearest
/// points of the outline, in directions that differ by 120 degrees or more and on segments without a common end. The
/// axis of a channel counts, and that of a corner does not, unless its sides meet at less than 60 degrees, and then
/// only as far as its two segments are not nearest. Points that are farther from the outline than all around them
/// count anyway.
///
/// Found in the squares of a quadtree that keep the segments that can be nearest in them, and are divided until they
/// are small compared with the distance. Pieces leave the axis, which is curved around points, by less than a
/// hundredth of that. No segment has equal ends.
[[nodiscard]] std::vector<AxisPiece> medial_axis(const OutlineSegments& outline);

/// Into an order that depends on where they are alone.
void sort_segments(OutlineSegments& outline);

}  // namespace driftmesh
