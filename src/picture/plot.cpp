#include "picture/plot.hpp"

#include <charconv>

#include "driftmesh/error.hpp"
#include "picture/plot_values.hpp"

namespace driftmesh {
namespace {

void require_listed(bool listed, const PlotOptions& options, const char* what) {
  if (listed) return;
  throw InputError({options.name, 0}, std::string("does not list the ") + what + " of its triangles",
                   "only .pvtu, .vtu and .msh files of distributed meshes do; choose another color");
}

std::string short_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 10).ptr};
}

std::string text_of(const Point& p) {
  return "(" + short_text(p.x) + ", " + short_text(p.y) + ")";
}

/// `shows`: whether there is anything in the box.
void require_shown(bool shows, const std::vector<Point>& points, const PlotOptions& options) {
  if (shows || points.empty()) return;
  const Box extent = Box::of(points);
  throw InputError(
      {options.name, 0},
      "has nothing in the box given: it extends from " + text_of(extent.low) + " to " + text_of(extent.high),
      "choose a part of that");
}

bool shows_any(const Mesh& mesh, const Box& box) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_shown(mesh, t, box)) return true;
  return false;
}

}  // namespace

void plot(const Mesh& mesh, const std::string& path, const PlotOptions& options) {
  if (options.box) require_shown(shows_any(mesh, shown_box(options, {})), mesh.points, options);
  if (options.color == PlotColor::kSubdomain) require_listed(!mesh.subdomains.empty(), options, "subdomain");
  if (options.color == PlotColor::kRank) require_listed(!mesh.ranks.empty(), options, "rank");
  plot_mesh(mesh, path, options);
}

void plot(const Pslg& input, const std::string& path, const PlotOptions& options) {
  require_shown(!options.box || shown_box(options, {}).overlaps(Box::of(input.points)), input.points, options);
  plot_pslg(input, path, options);
}

}  // namespace driftmesh
