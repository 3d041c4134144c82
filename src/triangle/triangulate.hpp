#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "triangle/switches.hpp"
#include "triangle/tables.hpp"

namespace driftmesh::triangle {

/// What a caller may have besides tables and switches.
struct Caller {
  /// For the switch u: whether a triangle with these corners and this area is to be refined. Must depend on them alone,
  /// and accept all small ones.
  std::function<bool(const Point&, const Point&, const Point&, double)> unsuitable{};
  /// For the switch u, instead: target edge lengths as an expression (docs/size-expressions.md).
  std::string size{};
  std::function<void(const std::string&)> warning{};
  std::function<bool()> goes_on{};  ///< asked from time to time; false cancels the work with Cancelled
  std::int64_t max_triangles = 0;   ///< beyond it, LimitError; 0: as many as memory allows
};

/// A mesh, and its Voronoi diagram if the switches ask for it. The points of the input come first, in its order, all of
/// them unless points are jettisoned; tables that the switches do not ask for are empty. Segments are the constrained
/// edges of the mesh, holes and regions those of the input.
struct Result {
  Tables mesh;
  Voronoi voronoi;
};

/// Makes the mesh that Triangle's switches ask for: the Delaunay triangulation of points, the constrained one of
/// segments (p), or a refined mesh (r), in which angles and areas are within the bounds except where the rules of
/// insertion or small input angles do not allow it (docs/guarantees.md). Without q, a, u, D and s no points are added
/// but where segments cross. Markers follow Triangle's rules: those of the input count, those of segments go to the
/// points and edges on them, and 1 is that of the rest of the boundary. Throws InputError, Error for switches,
/// LimitError, Cancelled, and what callables of the caller throw.
[[nodiscard]] Result triangulate(const Tables& input, const Switches& switches, const Caller& caller = {});

/// What was made, in a few lines for users: counts, areas and angles.
[[nodiscard]] std::string statistics(const Tables& input, const Tables& mesh);

}  // namespace driftmesh::triangle
