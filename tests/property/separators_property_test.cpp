#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/predicates.hpp"
#include "oracles/meshing.hpp"
#include "property/cases.hpp"
#include "support/cut_mesh_size.hpp"
#include "support/made_mesh.hpp"
#include "support/separator_room_oracle.hpp"

// Separators cost few triangles, wherever the domain has points that nearly lie on a line or nearly touch.

using namespace driftmesh;
using namespace driftmesh::oracles;

namespace {

using Random = std::mt19937_64;

double unit(Random& random) {
  return std::uniform_real_distribution<double>(0, 1)(random);
}

int from_to(Random& random, int least, int most) {
  return std::uniform_int_distribution<int>(least, most)(random);
}

/// A point as a table with this many decimals has it.
Point rounded(const Point& p, int decimals) {
  const double scale = std::pow(10, decimals);
  return {std::round(p.x * scale) / scale, std::round(p.y * scale) / scale};
}

Point turned(const Point& p, double angle) {
  return {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle)};
}

Point moved(const Point& p, const Point& by) {
  return {p.x + by.x, p.y + by.y};
}

void close_ring(Pslg& pslg, std::int32_t first) {
  const auto last = static_cast<std::int32_t>(pslg.points.size()) - 1;
  for (std::int32_t i = first; i <= last; ++i) pslg.segments.push_back({i, i < last ? i + 1 : first, 1});
}

/// Soundings on a grid, without segments: most points of the border lie just inside the hull.
Pslg turned_grid(Random& random) {
  Pslg pslg;
  const int columns = from_to(random, 3, 20), rows = from_to(random, 3, 20), decimals = from_to(random, 2, 9);
  const double step = std::pow(10, 2 * unit(random)), angle = 2 * std::numbers::pi * unit(random);
  const Point origin = random() % 2 == 0 ? Point{0, 0} : Point{500000, 4000000};
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j)
      pslg.points.push_back(rounded(moved(turned({step * i, step * j}, angle), origin), decimals));
  return pslg;
}

/// The outline of a plot: straight lines with many points that are rounded to millimeters, and marks inside, some of
/// which lie nearly on a line through the plot.
Pslg rounded_survey(Random& random) {
  Pslg pslg;
  const double width = 100 + 900 * unit(random), height = 100 + 900 * unit(random);
  const double angle = 2 * std::numbers::pi * unit(random);
  const Point corners[] = {{0, 0}, {width, 0}, {width * (0.6 + 0.4 * unit(random)), height}, {0, height}};
  const auto place = [&](const Point& p) { return rounded(turned(p, angle), 3); };
  const auto along = [](const Point& a, const Point& b, double t) {
    return Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
  };
  for (std::size_t k = 0; k < 4; ++k) {
    const int parts = from_to(random, 2, 40);
    for (int i = 0; i < parts; ++i)
      pslg.points.push_back(place(along(corners[k], corners[(k + 1) % 4], (i + 0.8 * unit(random)) / parts)));
  }
  close_ring(pslg, 0);
  const Point from{0.2 * width, 0.2 * height}, to{0.6 * width * unit(random), 0.8 * height};
  for (int i = 0; i <= 10; ++i) pslg.points.push_back(place(along(from, to, 0.1 * i)));
  return pslg;
}

/// Fractures in a square: inner segments of which most end just before another one.
Pslg touching_fractures(Random& random) {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  close_ring(pslg, 0);
  const double gap = std::pow(10, -3 - 6 * unit(random));
  std::vector<std::array<Point, 2>> fractures;
  const auto crosses_any = [&](const Point& a, const Point& b) {
    return std::ranges::any_of(fractures, [&](const auto& f) {
      return orient2d(a, b, f[0]) * orient2d(a, b, f[1]) <= 0 && orient2d(f[0], f[1], a) * orient2d(f[0], f[1], b) <= 0;
    });
  };
  const int count = from_to(random, 2, 40);
  for (int tries = 0; tries < 50 * count && static_cast<int>(fractures.size()) < count; ++tries) {
    const double angle = 2 * std::numbers::pi * unit(random), length = 0.1 + 0.4 * unit(random);
    Point a{0.05 + 0.9 * unit(random), 0.05 + 0.9 * unit(random)};
    if (!fractures.empty()) {  // beside an earlier one
      const auto& f = fractures[static_cast<std::size_t>(from_to(random, 0, static_cast<int>(fractures.size()) - 1))];
      const double t = 0.1 + 0.8 * unit(random), dx = f[1].x - f[0].x, dy = f[1].y - f[0].y;
      const double away = (random() % 2 == 0 ? gap : -gap) / std::hypot(dx, dy);
      a = {f[0].x + t * dx - away * dy, f[0].y + t * dy + away * dx};
    }
    const Point b = moved(a, turned({length, 0}, angle));
    const auto inside = [](const Point& p) { return std::min({p.x, p.y, 1 - p.x, 1 - p.y}) > 0.02; };
    if (!inside(a) || !inside(b) || crosses_any(a, b)) continue;
    fractures.push_back({a, b});
    const auto first = static_cast<std::int32_t>(pslg.points.size());
    pslg.points.insert(pslg.points.end(), {a, b});
    pslg.segments.push_back({first, first + 1, 2});
  }
  return pslg;
}

Pslg coast(Random& random) {
  BayOptions options;
  options.resolution = 300 + 1200 * unit(random);
  options.roughness = unit(random);
  options.seed = random() % 1000;
  return generate_bay(options);
}

struct Kind {
  const char* name;
  Pslg (*make)(Random&);
};
constexpr Kind kKinds[] = {{"turned grid", turned_grid},
                           {"rounded survey", rounded_survey},
                           {"touching fractures", touching_fractures},
                           {"coast", coast}};

/// The triangles of a mesh in subdomains over those that are allowed: at most 1 where all is well.
double relative_size(const testing::CutMeshSize& cut, std::size_t in_one_piece) {
  return static_cast<double>(cut.triangles) /
         (1.1 * static_cast<double>(in_one_piece) + 4 * static_cast<double>(cut.separator_edges));
}

struct Tally {
  std::size_t cuts = 0, edges = 0;
  double worst = 0;
};

/// Makes meshes of a domain in several numbers of subdomains, and compares them to those in one piece.
void check_cuts(const Pslg& input, Tally& tally) {
  const double area = testing::made(input, testing::bounded(20)).record.shape.total_area;
  for (const double asked : {0.0, 3000.0})
    for (const int n : {2, 16, 60}) {
      CAPTURE(asked);
      CAPTURE(n);
      job::Request request = testing::bounded(20, asked > 0 ? area / asked : 0);
      const std::size_t in_one_piece = testing::made(input, request).mesh.triangles.size();
      const auto most = static_cast<std::int64_t>(20000 + 4 * in_one_piece);
      const testing::CutMeshSize cut = testing::cut_mesh_size(input, request, n, most);
      CHECK(testing::separator_without_room(cut.decomposition) == "");
      CHECK(cut.complete);
      CHECK(relative_size(cut, in_one_piece) <= 1);
      tally.worst = std::max(tally.worst, relative_size(cut, in_one_piece));
      tally.edges += cut.separator_edges;
      ++tally.cuts;
    }
}

}  // namespace

TEST_CASE("a mesh in subdomains has few triangles more than one in one piece") {
  Random random = testing::seeded_generator("separators_property_test");
  Tally tally;
  for (std::int64_t i = 0; i < testing::case_count(24); ++i) {
    const Kind& kind = kKinds[static_cast<std::size_t>(i) % std::size(kKinds)];
    Random own(random());
    Pslg input = kind.make(own);
    repair(input);
    CAPTURE(i);
    CAPTURE(kind.name);
    CAPTURE(poly_text(input));
    check_cuts(input, tally);
  }
  MESSAGE(tally.cuts << " decompositions with " << tally.edges << " edges on separators; at worst " << tally.worst
                     << " times the triangles allowed");
  CHECK(tally.edges > 0);
}
