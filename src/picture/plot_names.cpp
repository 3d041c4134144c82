#include "picture/plot.hpp"

namespace driftmesh {

const PlotNames<PlotColor>& plot_colors() {
  static const PlotNames<PlotColor> names = {{"auto", PlotColor::kAutomatic},      {"angle", PlotColor::kAngle},
                                             {"area", PlotColor::kArea},           {"region", PlotColor::kRegion},
                                             {"subdomain", PlotColor::kSubdomain}, {"rank", PlotColor::kRank},
                                             {"none", PlotColor::kPlain}};
  return names;
}

const PlotNames<PlotEdges>& plot_edges() {
  static const PlotNames<PlotEdges> names = {
      {"auto", PlotEdges::kAutomatic}, {"on", PlotEdges::kOn}, {"off", PlotEdges::kOff}};
  return names;
}

}  // namespace driftmesh
