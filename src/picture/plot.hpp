#pragma once

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

/// Whether `path` can name a picture: it ends in .png, .svg or .pdf, or is "-" (PNG to standard output).
[[nodiscard]] bool is_picture_name(const std::string& path);

// plot() without its checks of colors and boxes: a picture may be empty.
void plot_mesh(const Mesh& mesh, const std::string& path, const PlotOptions& options);
void plot_pslg(const Pslg& pslg, const std::string& path, const PlotOptions& options);

}  // namespace driftmesh
