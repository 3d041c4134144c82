#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "driftmesh/plot.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh {

/// What a picture of sizes shows of a domain.
struct DomainShape {
  std::vector<std::array<Point, 3>> triangles;  ///< cover it
  std::vector<std::array<Point, 2>> segments;
};

/// Draws what a size field asks for, the length of edges at each pixel, as colors on a logarithmic scale whose
/// histogram shows shares of the area, and the domain's segments. Throws FileError, and what `length_at` throws.
void plot_sizes(const DomainShape& domain, const std::function<double(const Point&)>& length_at,
                const std::string& path, const PlotOptions& options);

}  // namespace driftmesh
