#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "adapt/fields.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/mesh.hpp"
#include "patch/new_outline.hpp"
#include "patch/part.hpp"
#include "runtime/plan_run.hpp"

namespace driftmesh::patch {

/// What is to be made anew.
struct Order {
  std::vector<bool> inside{};     ///< one for each triangle; empty: none
  std::vector<double> lengths{};  ///< wanted, one for each point; empty: those that the triangles have
  AdaptiveOptions options{};      ///< for lengths; most_triangles: what is made anew has no more; 0: no limit
  double min_angle = defaults::kMinAngle;
  std::int32_t threads = 1;           ///< nothing depends on their number but time
  double cut_from = kWorthCutting;    ///< triangles for which all of a mesh is made anew in subdomains
  std::optional<Linked> linked{};     ///< the mesh, if that is there already
  const NewDomain* domain = nullptr;  ///< null: that of the mesh; else what differs is made anew, too
};

struct Report {
  std::int64_t inside = 0;       ///< triangles that were to be made anew
  std::int64_t gone = 0;         ///< triangles that are no longer there
  std::int64_t made = 0;         ///< new triangles
  std::int64_t margin = 0;       ///< triangles that are gone without having been inside
  double margin_width = 0;       ///< no point of these is farther from what was inside
  std::int64_t gone_points = 0;  ///< points that are no longer there
  std::int64_t new_points = 0;

  // Only with a new domain:
  std::int64_t gone_edges = 0;     ///< those of the old outline that are not on the new one
  std::int64_t pieces = 0;         ///< those of the new outline that are not on the old one
  std::int64_t beyond = 0;         ///< new points where the old mesh was not
  std::int64_t other_markers = 0;  ///< edges that keep their markers although the new domain has others there
};

struct Remade {
  Mesh mesh;
  std::vector<adapt::Field> fields;
  std::vector<std::int32_t> old_points;     ///< for each point its number in the old mesh; -1: it is new
  std::vector<std::int32_t> old_triangles;  ///< the same for triangles
  Report report;
};

/// Makes parts of a mesh anew for lengths and an angle bound, and as much around them as the bound takes. Everything
/// beyond stays bit for bit: points, triangles with their corners in order, edges, markers, and numbers (see splice).
/// The new triangles are Delaunay, also together with what stays. Fields are carried over; the mesh has no attributes
/// of its own. Throws Error for a mesh that is not sound, for triangles that are clockwise or do not fit together, for
/// lengths that are not positive, and LimitError.
///
/// With a new domain, what is to be made anew is all that compare_outlines finds. Where the new domain is beyond the
/// old mesh, lengths and fields are those at the nearest place of it that is taken; conserve() refuses fields there.
/// Edges that stay keep their markers.
[[nodiscard]] Remade remake(Mesh mesh, std::vector<adapt::Field> fields, Order order);

}  // namespace driftmesh::patch
