#pragma once

#include <optional>
#include <string>

#include "driftmesh/mesh.hpp"
#include "driftmesh/point.hpp"
#include "driftmesh/pslg.hpp"

// Pictures, by a library of their own: driftmesh::pictures.
namespace driftmesh {

/// The quantity that a triangle's color shows.
enum class PlotColor {
  kAutomatic,  ///< the angle, or the area where triangles are too small to be seen
  kAngle,      ///< its smallest angle, 0 to 60 degrees
  kArea,       ///< its area, on a logarithmic scale
  kRegion,     ///< its region attribute
  kSubdomain,  ///< the subdomain that it was made in, if the mesh lists it
  kRank,       ///< the rank that made it, if the mesh lists it
  kPlain       ///< nothing: one light color for all
};

enum class PlotEdges {
  kAutomatic,  ///< drawn where they are long enough to be seen; none in a density image
  kOn,         ///< always drawn, however small; slow for millions of lines
  kOff
};

/// A part of the plane: low.x < high.x and low.y < high.y.
struct PlotBox {
  Point low{};
  Point high{};
};

struct PlotOptions {
  std::string name = "the input";  ///< what is drawn, for messages
  int width = 1600;                ///< pixels (points in PDF)
  int height = 0;                  ///< 0: chosen to fit what is shown
  PlotColor color = PlotColor::kAutomatic;
  PlotEdges edges = PlotEdges::kAutomatic;
  std::optional<PlotBox> box{};  ///< the part of the plane to show; absent: everything
  std::string title{};
  std::string subtitle{};  ///< instead of the numbers of triangles and points and the angles
  bool counts = true;      ///< numbers of triangles in the legend of regions, subdomains and ranks
  bool legend = true;      ///< false where colors merely distinguish neighbors
};

/// Draws the mesh as .png, .svg or .pdf, by the extension of `path`; "-" is PNG to standard output. Triangles of less
/// than about two pixels on average are not drawn one by one: each pixel then shows the worst angle of the triangles in
/// it, or the mean of the logarithms of the areas of those around it. Throws InputError for an unknown extension or an
/// impossible size, for a box with nothing in it, and for a color that shows what the mesh does not list; FileError.
///
/// \code
/// const driftmesh::Pslg pipe = driftmesh::generate("pipe");
/// driftmesh::plot(pipe, "domain.svg");
/// driftmesh::plot(driftmesh::mesh(pipe), "pipe.png", {.width = 800, .color = driftmesh::PlotColor::kArea});
/// \endcode
void plot(const Mesh& mesh, const std::string& path, const PlotOptions& options = {});

/// Draws segments by marker, points (if there are not too many), holes as crosses and regions with their labels; of an
/// input with polygons, the domain that they describe. Throws likewise.
void plot(const Pslg& input, const std::string& path, const PlotOptions& options = {});

}  // namespace driftmesh
