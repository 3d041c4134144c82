#include <cairo.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/with_seeds.hpp"
#include "picture/plot.hpp"
#include "picture/plot_canvas.hpp"
#include "picture/plot_frame.hpp"
#include "picture/plot_legend.hpp"
#include "picture/plot_lines.hpp"
#include "picture/plot_scale.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMostPoints = 3000;  // more dots would hide the segments

Box box_of(const Pslg& pslg) {
  Box box;
  for (const Point& p : pslg.points) box.extend(p);
  for (const Point& p : pslg.holes) box.extend(p);
  for (const Pslg::Region& region : pslg.regions) box.extend(region.at);
  const double margin = 0.02 * std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  return {{box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin}};
}

// The closed curves that the segments form; empty if they form anything else.
class Loops {
 public:
  explicit Loops(const Pslg& pslg) : neighbors_(pslg.points.size(), {-1, -1}) {
    for (const Pslg::Segment& segment : pslg.segments)
      if (segment.a == segment.b || !connect(segment.a, segment.b) || !connect(segment.b, segment.a)) return;
    for (const Pslg::Segment& segment : pslg.segments)
      if (neighbors_[segment.a][1] < 0 || neighbors_[segment.b][1] < 0) return;
    std::vector<bool> seen(pslg.points.size(), false);
    for (const Pslg::Segment& segment : pslg.segments)
      if (!seen[segment.a]) loops.push_back(walk(segment.a, seen));
  }

  std::vector<std::vector<std::int32_t>> loops;

 private:
  bool connect(std::int32_t from, std::int32_t to) {
    auto& slots = neighbors_[from];
    if (slots[1] >= 0) return false;
    slots[slots[0] < 0 ? 0 : 1] = to;
    return true;
  }

  std::vector<std::int32_t> walk(std::int32_t start, std::vector<bool>& seen) const {
    std::vector<std::int32_t> loop;
    for (std::int32_t v = start; v >= 0;) {
      seen[v] = true;
      loop.push_back(v);
      const auto& [first, second] = neighbors_[v];
      v = !seen[first] ? first : !seen[second] ? second : -1;
    }
    return loop;
  }

  std::vector<std::array<std::int32_t, 2>> neighbors_;
};

class PslgPlot {
 public:
  PslgPlot(const Pslg& pslg, const std::string& path, const PlotOptions& options)
      : pslg_(pslg),
        options_(options),
        colors_(color_markers()),
        frame_(shown_box(options, box_of(pslg)), options.width, options.height, colors_.size() > 1),
        canvas_(path, frame_.width(), frame_.height()) {}

  void draw() {
    frame_.draw_title(canvas_, options_.title, subtitle());
    frame_.draw_axes(canvas_);
    frame_.begin_clip(canvas_);
    fill_domain();
    draw_segments();
    draw_points();
    for (const Point& hole : pslg_.holes) draw_cross(frame_.to_pixels(hole));
    for (const Pslg::Region& region : pslg_.regions) draw_region(region);
    PlotFrame::end_clip(canvas_);
    draw_legend();
    canvas_.commit();
  }

 private:
  struct Marker {
    Rgb color;
    std::size_t segments = 0;
  };

  std::map<std::int32_t, Marker> color_markers() const {
    std::map<std::int32_t, Marker> colors;
    for (const Pslg::Segment& segment : pslg_.segments) ++colors[segment.marker].segments;
    std::size_t index = 0;
    for (auto& [marker, entry] : colors) entry.color = colors.size() == 1 ? kInk : category_line_color(index++);
    return colors;
  }

  static std::string counted(std::size_t count, const std::string& what) {
    return grouped_digits(count) + " " + what + (count == 1 ? "" : "s");
  }

  [[nodiscard]] std::string subtitle() const {
    std::string text = counted(pslg_.points.size(), "point") + "   " + counted(pslg_.segments.size(), "segment");
    if (!pslg_.holes.empty()) text += "   " + counted(pslg_.holes.size(), "hole");
    if (!pslg_.regions.empty()) text += "   " + counted(pslg_.regions.size(), "region");
    return text;
  }

  // The domain is known without a mesh if the segments form one outer curve and one curve around each hole. Otherwise
  // nothing is filled.
  void fill_domain() {
    const Loops curves(pslg_);
    if (curves.loops.size() != pslg_.holes.size() + 1) return;
    cairo_t* const cairo = canvas_.cairo();
    for (const auto& loop : curves.loops) {
      cairo_new_sub_path(cairo);
      for (std::int32_t v : loop) {
        const Point p = frame_.to_pixels(pslg_.points[v]);
        cairo_line_to(cairo, p.x, p.y);
      }
      cairo_close_path(cairo);
    }
    cairo_set_fill_rule(cairo, CAIRO_FILL_RULE_EVEN_ODD);
    canvas_.set_color(kPlainFill);
    cairo_fill(cairo);
  }

  void draw_segments() {
    const double width = (pslg_.segments.size() > kMostPoints ? 0.9 : 1.5) * frame_.unit();
    for (const auto& [marker, entry] : colors_) {
      LineBatch batch(canvas_, width, entry.color);
      for (const Pslg::Segment& segment : pslg_.segments)
        if (segment.marker == marker)
          batch.add(frame_.to_pixels(pslg_.points[segment.a]), frame_.to_pixels(pslg_.points[segment.b]));
    }
  }

  void draw_points() {
    if (pslg_.points.size() > kMostPoints) return;
    const double radius = (pslg_.points.size() > 300 ? 1.5 : 2.6) * frame_.unit();
    canvas_.set_color(kInk);
    for (const Point& point : pslg_.points) {
      const Point p = frame_.to_pixels(point);
      cairo_arc(canvas_.cairo(), p.x, p.y, radius, 0, 2 * std::numbers::pi);
      cairo_fill(canvas_.cairo());
    }
  }

  void draw_cross(const Point& p) {
    const double arm = (pslg_.holes.size() > 12 ? 3 : 5) * frame_.unit();
    canvas_.line({p.x - arm, p.y - arm}, {p.x + arm, p.y + arm}, 0.35 * arm, kAlarm);
    canvas_.line({p.x - arm, p.y + arm}, {p.x + arm, p.y - arm}, 0.35 * arm, kAlarm);
  }

  void draw_region(const Pslg::Region& region) {
    const Point p = frame_.to_pixels(region.at);
    const double u = frame_.unit();
    canvas_.fill_rect({p.x - 3 * u, p.y - 3 * u, 6 * u, 6 * u}, kRegionMark);
    std::string label = "region " + friendly_number(region.attribute, 6);
    if (region.max_area > 0) label += ", area \u2264 " + friendly_number(region.max_area);
    canvas_.text({p.x, p.y + 18 * u}, label,
                 {.size = 12.5 * u, .color = kRegionMark, .align = TextAlign::kCenter, .halo = true});
  }

  void draw_legend() {
    if (colors_.size() < 2) return;
    std::vector<Swatch> swatches;
    for (const auto& [marker, entry] : colors_)
      swatches.push_back({entry.color, std::to_string(marker) + "  (" + grouped_digits(entry.segments) + ")"});
    draw_swatches(canvas_, frame_, "Marker (segments)", swatches);
  }

  static constexpr Rgb kRegionMark{0.10, 0.38, 0.60};

  const Pslg& pslg_;
  const PlotOptions& options_;
  std::map<std::int32_t, Marker> colors_;
  PlotFrame frame_;
  Canvas canvas_;
};

/// Only its domain is drawn if it has polygons; but all of it if they are too broken to have one.
Pslg without_polygons(Pslg pslg) {
  Pslg lines = pslg;
  lines.polygons.clear();
  lines.regions.clear();
  try {
    static_cast<void>(repair(pslg));
    return with_seeds(pslg);
  } catch (const Error&) {
    return lines;
  }
}

}  // namespace

void plot_pslg(const Pslg& pslg, const std::string& path, const PlotOptions& options) {
  if (pslg.polygons.empty())
    PslgPlot(pslg, path, options).draw();
  else
    PslgPlot(without_polygons(pslg), path, options).draw();
}

}  // namespace driftmesh
