#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/plot.hpp"
#include "driftmesh/pslg.hpp"
#include "geometry/box.hpp"

namespace driftmesh {

/// Values of an option by their names, the default first.
template <class Value>
using PlotNames = std::vector<std::pair<std::string, Value>>;
[[nodiscard]] const PlotNames<PlotColor>& plot_colors();
[[nodiscard]] const PlotNames<PlotEdges>& plot_edges();

/// What is to be shown of something that fills `whole`.
[[nodiscard]] inline Box shown_box(const PlotOptions& options, const Box& whole) {
  return options.box ? Box{options.box->low, options.box->high} : whole;
}

/// With space around what it holds, so that boundary lines are not cut in half.
[[nodiscard]] inline Box with_margin(const Box& box) {
  const double margin = 0.012 * std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  return {{box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin}};
}

/// Whether `path` can name a picture: it ends in .png, .svg or .pdf, or is "-" (PNG to standard output).
[[nodiscard]] bool is_picture_name(const std::string& path);

// plot() without its checks of colors and boxes: a picture may be empty.
void plot_mesh(const Mesh& mesh, const std::string& path, const PlotOptions& options);
void plot_pslg(const Pslg& pslg, const std::string& path, const PlotOptions& options);

}  // namespace driftmesh
