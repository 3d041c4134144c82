#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/point.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A point that represents some of the work around it.
struct WorkSample {
  Point at;
  double work;  ///< triangles
};

/// Samples in ascending order of y. There is no formula for the work in an area that a size function or details of the
/// input require, so it is sampled.
using WorkSamples = std::vector<WorkSample>;

/// The number of triangles that refinement to `bounds` is expected to make, in about `count` samples of similar work.
/// With a size field, at the centroids of a coarse mesh graded by it (more if features of the domain require them);
/// without one, by the forecast (see Forecast), `forecast` in all. Empty if work is in proportion to area (see
/// work_density).
[[nodiscard]] WorkSamples sample_work(const Triangulation& mesh, const QualityBounds& bounds, double forecast,
                                      double count);

[[nodiscard]] double work_of(const WorkSamples& samples);

/// The work of the samples from which a ray to the right meets edge ab, > 0 if the edge goes up and < 0 if it goes
/// down. Over all edges of a counterclockwise border this sums to the work inside.
[[nodiscard]] double crossing_work(std::span<const WorkSample> samples, const Point& a, const Point& b);

/// Moves the samples inside the closed counterclockwise `border` out of `samples`; both keep their order.
[[nodiscard]] WorkSamples take_inside(WorkSamples& samples, std::span<const Point> border);

/// Every k-th sample, about `most` in total, representing all the work.
[[nodiscard]] WorkSamples thinned(const WorkSamples& samples, std::size_t most);

}  // namespace driftmesh
