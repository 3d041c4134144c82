#include "pslg/shape_builder.hpp"

#include <algorithm>
#include <cmath>

#include "base/narrow.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"

namespace driftmesh {

void require_option(bool condition, const std::string& kind, const std::string& what) {
  if (!condition) throw InputError("generate " + kind + ": " + what);
}

std::int32_t edges_for(double length, double edge, std::int32_t least) {
  const double edges = std::ceil(length / edge * (1 - 1e-12));
  if (!(edges < 1e8)) throw InputError("generate: the edge length is too small for this shape; choose a larger one");
  return std::max(least, static_cast<std::int32_t>(edges));
}

Chain arc(const Point& center, double radius, double from, double to, std::int32_t edges) {
  const bool closes = std::fabs(to - from) >= 2 * kPi * (1 - 1e-12);
  Chain chain;
  for (std::int32_t i = 0; i < edges + (closes ? 0 : 1); ++i) {
    const double angle = from + (to - from) * i / edges;
    chain.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
  }
  return chain;
}

void line_to(Chain& chain, Point to, double edge) {
  const Point from = chain.back();
  const std::int32_t edges = edges_for(std::hypot(to.x - from.x, to.y - from.y), edge, 1);
  for (std::int32_t i = 1; i < edges; ++i) {
    const double t = static_cast<double>(i) / edges;
    chain.push_back({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)});
  }
  chain.push_back(to);
}

void add_loop(Pslg& pslg, const Chain& loop, std::int32_t marker) {
  const auto first = narrow<std::int32_t>(pslg.points.size(), "vertices");
  const auto count = narrow<std::int32_t>(loop.size(), "vertices");
  pslg.points.insert(pslg.points.end(), loop.begin(), loop.end());
  for (std::int32_t i = 0; i < count; ++i) pslg.segments.push_back({first + i, first + (i + 1) % count, marker});
}

Pslg checked(Pslg pslg, const std::string& kind) {
  const RepairReport report = repair(pslg, "generate " + kind);
  if (report.changed() || !report.warnings.empty())
    throw InputError("generate " + kind + ": with these options the shape overlaps itself; change them\n" +
                     report.summary());
  return pslg;
}

}  // namespace driftmesh
