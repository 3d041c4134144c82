#pragma once

#include "driftmesh/pslg.hpp"
#include "mesh/carve.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The constrained Delaunay triangulation of the domain that a PSLG describes: everything outside its outer boundary
/// and everything reachable from its hole points removed, triangles labeled by region. Vertex origins are indices into
/// `pslg.points`; roots are in the order of `pslg.segments`, without those that bound no part of the domain. Region
/// labels: 0 is "no region point", i + 1 is pslg.regions[i]; the array is empty if there are no region points.
/// Triangles are in Hilbert order.
///
/// The PSLG must be as repair() leaves it: distinct points in coordinate range, segments that meet only at shared ends.
/// Without segments, the convex hull of the points is the domain. Throws Error if the PSLG is not repaired, if its
/// points are collinear, or if it encloses nothing (the message names the cause: an open boundary, or hole points that
/// empty the domain). `report`, if not null, receives what carving found.
[[nodiscard]] Triangulation triangulate(const Pslg& pslg, CarveReport* report = nullptr);

/// The same for a domain that is defined by the sides of its segments, one entry for each of pslg.segments, instead of
/// by hole and region points, each with the lower one of its points first: the domain is what can be reached from an
/// inner side without crossing a segment. Every segment needs an inner side. Region labels are those of the sides; the
/// array is empty if all of them are equal to 0.
[[nodiscard]] Triangulation triangulate(const Pslg& pslg, const std::vector<SegmentSides>& sides);

}  // namespace driftmesh
