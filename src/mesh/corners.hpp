#pragma once

#include <cstdint>

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// What a mesh with acute corners is prepared for.
struct CornerUse {
  /// The largest angle bound, in degrees.
  double min_angle = kMaxAngle;
  /// Whether separators are to end on segments. They can only halve all pieces of a shell at once, so shells are short
  /// then: they begin at half the distance, and no whole segment is one.
  bool decomposed = true;
  InsertionRules rules{};
};

/// Whether a rule lets points be put on a leaf.
[[nodiscard]] bool may_split(const Triangulation& mesh, SubsegmentId s, InsertionRules::Split split);

/// Prepares a triangulation for refinement at its acute corners, so that midpoint splits terminate there.
///
/// Where segments meet inside the domain at a small angle, splitting one can force a split of the other, and so on
/// forever. The known cure is to cut all segments of such a cluster on common circles around the apex, whose radii are
/// powers of two (Ruppert's shells). Here they are cut once, before refinement: at the largest power of two that is at
/// most two thirds of each segment (a third, if it ends in another cluster). The piece between apex and circle becomes
/// a root segment of its own (a shell piece, directed away from the apex). From then on plain midpoint splits stay on
/// common circles, and whether two vertices lie on the same one is a comparison of their dyadic paths. Segments of one
/// length need no cuts: they are shell pieces as they are, and the outermost pieces of segments of one length are, too.
///
/// How small an angle needs this follows from how large a triangle can be that makes a segment split. Let the pieces at
/// the apex have the lengths d <= e, and the segments meet at an angle a. A vertex on one is at least e sin a from one
/// on the other, so a triangle between them that misses an angle bound t has a circumradius of more than e sin a /
/// (2 sin t); and the piece of length e is not split for a triangle whose circumradius exceeds e / sqrt(3). So where
/// sin a >= 2 sin t / sqrt(3), a corner does not make its own pieces split, and away from the apex the segments are
/// apart. Closer segments than 30 degrees reach into each other's lenses and are always cut. That is all for bounds up
/// to 25.6 degrees; for 30 it takes 35.3 degrees, for 33 it takes 39. (This says nothing about two corners that make
/// each other's pieces split; no input has shown that.)
///
/// A sharp cluster, one with an angle below 20 degrees, is cut on every further power of two as well, as far as each
/// segment reaches; and where neighbors diverge by less than 0.01 radians, the longer one is also cut where the
/// shorter one ends. Pieces that do not line up there would be refined to the distance between the segments.
///
/// Segments are only cut as far as the rules allow. Meshes that are to be conforming are prepared at all angles below
/// 60 degrees: what protects a segment then is its whole diametral circle.
///
/// Returns the number of clusters of segments that meet at less than 60 degrees, cut or not. Call once, after
/// triangulate and before refinement.
std::int32_t prepare_corners(Triangulation& mesh, const CornerUse& use = {});

/// Whether both vertices lie on two segments of one acute corner, at the same distance from its apex: the edge between
/// them cannot be helped by splitting either ("seditious" in Shewchuk and Si's terms). In clusters that are not sharp,
/// the ends of the shell pieces do not count: beyond them, good triangles are cheap.
[[nodiscard]] bool on_same_shell(const Triangulation& mesh, VertexId u, VertexId v);

}  // namespace driftmesh
