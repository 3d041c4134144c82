#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A place that stands for some of the work around it.
struct WorkSample {
  Point at;
  double work;  ///< triangles
};

/// Samples of ascending y: the work of a sizing function has no formula, so it is looked up at points of a coarse mesh
/// that the function itself grades.
using WorkSamples = std::vector<WorkSample>;

/// The triangles that refinement to `bounds` can be expected to make, as the centroids of a mesh with about `count`
/// triangles of about equal work (more if features of the domain ask for them). Each of its triangles stays at least
/// one.
[[nodiscard]] WorkSamples sample_work(const Triangulation& mesh, const QualityBounds& bounds, double count);

/// The work of the samples that a ray to the right meets edge ab from, counted > 0 where the edge goes up and < 0 where
/// it goes down. Over all edges of a counterclockwise border this sums to the work inside.
[[nodiscard]] double crossing_work(std::span<const WorkSample> samples, const Point& a, const Point& b);

/// Moves the samples inside the closed counterclockwise `border` out of `samples`; both keep their order.
[[nodiscard]] WorkSamples take_inside(WorkSamples& samples, std::span<const Point> border);

/// Every k-th of many samples, about `most`, with their work.
[[nodiscard]] WorkSamples thinned(const WorkSamples& samples, std::size_t most);

}  // namespace driftmesh
