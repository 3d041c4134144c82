#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mesh/mesh_edges.hpp"
#include "picture/plot.hpp"
#include "picture/plot_canvas.hpp"
#include "picture/plot_frame.hpp"
#include "picture/plot_legend.hpp"
#include "picture/plot_lines.hpp"
#include "picture/plot_raster.hpp"
#include "picture/plot_scale.hpp"
#include "picture/plot_values.hpp"

namespace driftmesh {
namespace {

constexpr double kDenseSide = 2;               // pixels: smaller triangles are not drawn one by one
constexpr int kAveraged = 2;                   // pixels in each direction that a mean of areas goes over
constexpr double kShortestLine = 2;            // pixels: shorter edges are not drawn
constexpr std::size_t kMostPolygons = 150000;  // in a vector picture; more are drawn as an embedded image

Box box_of(const Mesh& mesh) {
  Box box;
  for (const Point& p : mesh.points) box.extend(p);
  return box;
}

/// The side of a triangle of mean area.
double mean_side(const PlotSummary& shown) {
  return std::sqrt(2 * shown.shown_area / std::max<double>(1, static_cast<double>(shown.shown_triangles)));
}

class MeshPlot {
 public:
  MeshPlot(const Mesh& mesh, const std::string& path, const PlotOptions& options)
      : mesh_(mesh),
        options_(options),
        frame_(shown_box(options, with_margin(box_of(mesh))), options.width, options.height, has_legend(options)),
        canvas_(path, frame_.width(), frame_.height()),
        summary_(summarize(mesh, frame_.shown())),
        mean_side_(mean_side(summary_) * frame_.scale()),
        is_dense_(mean_side_ < kDenseSide && options.edges != PlotEdges::kOn),
        color_(options.color != PlotColor::kAutomatic ? options.color
               : is_dense_                            ? PlotColor::kArea
                                                      : PlotColor::kAngle),
        values_(plot_values(mesh, color_, frame_.shown(), options.counts, is_dense_)) {}

  void draw() {
    frame_.draw_title(canvas_, options_.title, subtitle());
    frame_.draw_axes(canvas_);
    frame_.begin_clip(canvas_);
    draw_triangles();
    if (options_.edges != PlotEdges::kOff && !is_dense_) draw_edges();
    draw_segments();
    PlotFrame::end_clip(canvas_);
    draw_legend();
    canvas_.commit();
  }

 private:
  [[nodiscard]] Point corner(std::int32_t vertex) const { return frame_.to_pixels(mesh_.points[vertex]); }

  /// Whether colors show a quantity; otherwise they show categories.
  [[nodiscard]] bool is_range() const { return color_ == PlotColor::kAngle || color_ == PlotColor::kArea; }

  [[nodiscard]] static bool has_legend(const PlotOptions& options) {
    return options.legend && options.color != PlotColor::kPlain;
  }

  [[nodiscard]] std::string subtitle() const {
    if (!options_.subtitle.empty()) return options_.subtitle;
    std::string text =
        grouped_digits(mesh_.triangles.size()) + " triangles   " + grouped_digits(mesh_.points.size()) + " points";
    if (mesh_.triangles.empty()) return text;
    text += "   angles " + friendly_number(summary_.smallest_angle, 4) + "\u00b0 to " +
            friendly_number(summary_.largest_angle, 4) + "\u00b0";
    if (summary_.shown_triangles < mesh_.triangles.size())
      text += "   (" + grouped_digits(summary_.shown_triangles) + " triangles in view)";
    return text;
  }

  void draw_triangles() {
    if (canvas_.is_vector() && !is_dense_ && summary_.shown_triangles <= kMostPolygons)
      draw_polygons();
    else
      draw_raster();
  }

  // One path for each of 64 shades. A thin outline in the same color closes the seams that antialiasing leaves
  // between polygons that share an edge.
  void draw_polygons() {
    std::map<int, std::vector<std::size_t>> triangles_of_shade;
    const double to_shade = is_range() ? 64 / (values_.bar.high - values_.bar.low) : 1;
    const double low = is_range() ? values_.bar.low : 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (is_shown(mesh_, t, frame_.shown()))
        triangles_of_shade[static_cast<int>((values_.of_triangle[t] - low) * to_shade)].push_back(t);
    cairo_t* const cairo = canvas_.cairo();
    cairo_set_line_width(cairo, 0.4);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    for (const auto& [shade, triangles] : triangles_of_shade) {
      canvas_.set_color(values_.color_of(is_range() ? low + (shade + 0.5) / to_shade : shade));
      for (std::size_t t : triangles) add_polygon(mesh_.triangles[t]);
      cairo_fill_preserve(cairo);
      cairo_stroke(cairo);
    }
  }

  void add_polygon(const std::array<std::int32_t, 3>& triangle) {
    cairo_t* const cairo = canvas_.cairo();
    cairo_new_sub_path(cairo);
    for (std::int32_t vertex : triangle) {
      const Point p = corner(vertex);
      cairo_line_to(cairo, p.x, p.y);
    }
    cairo_close_path(cairo);
  }

  [[nodiscard]] ValueRaster::Keep what_a_pixel_keeps() const {
    if (!is_dense_ || !is_range()) return ValueRaster::Keep::kLast;
    return color_ == PlotColor::kAngle ? ValueRaster::Keep::kMinimum : ValueRaster::Keep::kMean;
  }

  void draw_raster() {
    const auto keep = what_a_pixel_keeps();
    ValueRaster raster(static_cast<int>(frame_.plot().width), static_cast<int>(frame_.plot().height),
                       keep == ValueRaster::Keep::kLast ? 3 : 1, keep);
    const Point origin{frame_.plot().x, frame_.plot().y};
    const auto inside = [&](std::int32_t vertex) {
      const Point p = corner(vertex);
      return Point{p.x - origin.x, p.y - origin.y};
    };
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      raster.add_triangle(inside(a), inside(b), inside(c), values_.of_triangle[t]);
    }
    if (keep == ValueRaster::Keep::kMean) raster.average_around(kAveraged);
    raster.paint(canvas_, origin, values_.color_of);
  }

  // The shorter the edges, the thinner the lines; where the mesh is too fine to be seen, they fade. Each class of
  // length (half a power of two) has its own pen. Inner edges are met from both sides, and drawn from the side where
  // their vertices ascend. Edges of a single triangle are constrained.
  void draw_edges() {
    using Line = std::array<Point, 2>;
    std::map<int, std::vector<Line>> lines_of_class;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!is_shown(mesh_, t, frame_.shown())) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = mesh_.triangles[t][i];
        const std::int32_t b = mesh_.triangles[t][(i + 1) % 3];
        if (a > b) continue;
        const Line line = {corner(a), corner(b)};
        const double length = std::hypot(line[1].x - line[0].x, line[1].y - line[0].y);
        if (length < kShortestLine && options_.edges != PlotEdges::kOn) continue;
        lines_of_class[std::clamp(static_cast<int>(std::floor(2 * std::log2(length))), 0, 14)].push_back(line);
      }
    }
    for (const auto& [length_class, lines] : lines_of_class) {
      const double length = std::exp2(length_class / 2.0);
      LineBatch batch(canvas_, std::clamp(0.05 * length, 0.3, 0.9 * frame_.unit()), kInk,
                      std::clamp(0.1 + 0.05 * length, 0.15, 0.65));
      for (const Line& line : lines) batch.add(line[0], line[1]);
    }
  }

  void draw_segments() {
    const double width = (is_dense_ ? 0.7 : std::clamp(0.12 * mean_side_, 0.8, 1.8)) * frame_.unit();
    LineBatch batch(canvas_, width, kInk);
    for (const Mesh::Edge& edge : mesh_.edges) batch.add(corner(edge.a), corner(edge.b));
    if (mesh_.edges.empty()) add_boundary(batch);
  }

  void add_boundary(LineBatch& batch) {
    const TriangleNeighbors neighbors = triangle_neighbors(mesh_);
    for (std::size_t t = 0; t < neighbors.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (neighbors[t][i] < 0)
          batch.add(corner(mesh_.triangles[t][(i + 1) % 3]), corner(mesh_.triangles[t][(i + 2) % 3]));
  }

  void draw_legend() {
    if (!has_legend(options_)) return;
    if (!is_range()) return draw_swatches(canvas_, frame_, values_.title, values_.swatches);
    ColorBar bar = values_.bar;
    if (is_dense_)
      bar.notes.emplace_back(color_ == PlotColor::kAngle ? "worst of each pixel" : "mean around each pixel");
    draw_color_bar(canvas_, frame_, bar);
  }

  const Mesh& mesh_;
  const PlotOptions& options_;
  PlotFrame frame_;
  Canvas canvas_;
  PlotSummary summary_;
  double mean_side_;  // pixels, for triangles in view
  bool is_dense_;
  PlotColor color_;
  PlotValues values_;
};

}  // namespace

void plot_mesh(const Mesh& mesh, const std::string& path, const PlotOptions& options) {
  MeshPlot(mesh, path, options).draw();
}

}  // namespace driftmesh
