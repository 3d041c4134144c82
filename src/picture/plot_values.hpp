#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "geometry/box.hpp"
#include "picture/plot.hpp"
#include "picture/plot_legend.hpp"

namespace driftmesh {

/// The values behind the triangles' colors, and their legend.
struct PlotValues {
  std::vector<float> of_triangle;       ///< degrees, log10(area), or number of the class
  std::function<Rgb(double)> color_of;  ///< color for a value
  ColorBar bar;                         ///< for angle and area
  std::string title;                    ///< heading of the swatches
  std::vector<Swatch> swatches;         ///< for region, subdomain and rank
};

/// The angles of the whole mesh, and how much of it is in view.
struct PlotSummary {
  double smallest_angle = 180;  ///< degrees
  double largest_angle = 0;     ///< degrees
  std::size_t shown_triangles = 0;
  double shown_area = 0;
};

/// Whether the box of triangle t meets the part of the plane that is shown.
[[nodiscard]] bool is_shown(const Mesh& mesh, std::size_t t, const Box& shown);

[[nodiscard]] PlotSummary summarize(const Mesh& mesh, const Box& shown);

/// The histogram and the range of areas are those of the triangles in view. A mesh that does not list regions,
/// subdomains or ranks counts as region, subdomain or rank 0. `counts`: swatches show how many triangles there are.
[[nodiscard]] PlotValues plot_values(const Mesh& mesh, PlotColor color, const Box& shown, bool counts = true,
                                     bool dense = false);

}  // namespace driftmesh
