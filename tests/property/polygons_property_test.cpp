#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/box.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "mesh/with_seeds.hpp"
#include "property/cases.hpp"

// Random polygons with corners on a small grid, which touch, overlap, cross and repeat themselves and each other. What
// they cover is summed up slab by slab between all heights where anything happens, by the definition of a polygon, and
// compared with the triangulation.

using namespace driftmesh;

namespace {

using Edge = std::pair<Point, Point>;

/// Areas of the regions by their index; those of -1 have none.
using RegionAreas = std::map<std::int32_t, double>;

/// All edges of the rings of an input.
struct Arranged {
  struct Entry {
    Edge edge;
    std::size_t polygon, ring;
  };
  std::vector<Entry> edges;
  std::vector<double> heights;

  explicit Arranged(const Pslg& input) {
    for (std::size_t p = 0; p < input.polygons.size(); ++p)
      for (std::size_t r = 0; r < input.polygons[p].rings.size(); ++r) {
        const Pslg::Ring& ring = input.polygons[p].rings[r];
        for (std::size_t i = 0; i < ring.size(); ++i)
          edges.push_back({{input.points[ring[i]], input.points[ring[(i + 1) % ring.size()]]}, p, r});
      }
    for (const Entry& e : edges) {
      heights.push_back(e.edge.first.y);
      for (const Entry& f : edges) add_crossing(e.edge, f.edge);
    }
    std::ranges::sort(heights);
  }

 private:
  void add_crossing(const Edge& e, const Edge& f) {
    const double ex = e.second.x - e.first.x, ey = e.second.y - e.first.y;
    const double fx = f.second.x - f.first.x, fy = f.second.y - f.first.y;
    const double turn = ex * fy - ey * fx;
    if (turn == 0) return;
    const double t = ((f.first.x - e.first.x) * fy - (f.first.y - e.first.y) * fx) / turn;
    if (t >= 0 && t <= 1) heights.push_back(e.first.y + t * ey);
  }
};

RegionAreas expected_areas(const Pslg& input) {
  const Arranged arranged(input);
  RegionAreas areas;
  for (std::size_t h = 1; h < arranged.heights.size(); ++h) {
    const double low = arranged.heights[h - 1], high = arranged.heights[h], y = low + (high - low) / 2;
    if (high <= low) continue;
    std::vector<std::pair<double, const Arranged::Entry*>> across;
    for (const auto& entry : arranged.edges) {
      const auto& [a, b] = entry.edge;
      if ((a.y <= y) != (b.y <= y)) across.emplace_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), &entry);
    }
    std::ranges::sort(across, {}, [](const auto& c) { return c.first; });
    std::vector<std::set<std::size_t>> inside(input.polygons.size());  // rings
    for (std::size_t i = 0; i + 1 < across.size(); ++i) {
      std::set<std::size_t>& rings = inside[across[i].second->polygon];
      if (!rings.erase(across[i].second->ring)) rings.insert(across[i].second->ring);
      bool covered = false;
      std::int32_t region = -1;
      for (std::size_t p = 0; p < input.polygons.size(); ++p) {
        if (inside[p] != std::set<std::size_t>{0}) continue;
        covered = true;
        if (input.polygons[p].region >= 0) region = input.polygons[p].region;
      }
      if (covered) areas[region] += (across[i + 1].first - across[i].first) * (high - low);
    }
  }
  return areas;
}

RegionAreas areas_of(const Triangulation& mesh) {
  RegionAreas areas;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive())
      areas[mesh.region.empty() ? -1 : mesh.region[t] - 1] +=
          signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  return areas;
}

/// All that polygons may do to each other happens often.
class RandomPolygons {
 public:
  explicit RandomPolygons(std::uint64_t seed) : random_(seed) {
    size_ = 2 + below(6);
    for (int y = 0; y <= size_; ++y)
      for (int x = 0; x <= size_; ++x) input_.points.push_back({static_cast<double>(x), static_cast<double>(y)});
    for (int left = 1 + below(4); left > 0; --left) add_polygon();
    if (below(4) == 0) add_segment(corner(), corner());
    stretch();
  }

  [[nodiscard]] const Pslg& input() const { return input_; }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  std::int32_t corner() { return below((size_ + 1) * (size_ + 1)); }

  void add_segment(std::int32_t a, std::int32_t b) {
    if (a != b) input_.segments.push_back({a, b, 1});
  }

  void add_polygon() {
    Pslg::Polygon polygon;
    for (int left = 1 + below(3); left > 0; --left) polygon.rings.push_back(ring());
    if (below(2) == 0) {
      if (input_.regions.empty() || below(2) == 0) input_.regions.push_back({{}, 1, 0});
      polygon.region = static_cast<std::int32_t>(input_.regions.size()) - 1;
    }
    for (const Pslg::Ring& ring : polygon.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) add_segment(ring[i], ring[(i + 1) % ring.size()]);
    input_.polygons.push_back(std::move(polygon));
  }

  Pslg::Ring ring() {
    if (below(5) == 0 && !input_.polygons.empty()) return input_.polygons.back().rings[0];
    Pslg::Ring ring;
    if (below(3) == 0) {
      const int x = below(size_), y = below(size_), w = 1 + below(size_ - x), h = 1 + below(size_ - y), row = size_ + 1;
      ring = {y * row + x, y * row + x + w, (y + h) * row + x + w, (y + h) * row + x};
    } else {
      for (int left = 3 + below(5); left > 0; --left) ring.push_back(corner());
    }
    if (below(4) == 0) {  // a way there and back
      const std::size_t at = random_() % ring.size();
      const std::int32_t from = ring[at];
      ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(at), {from, corner()});
    }
    return ring;
  }

  /// To coordinates that are not whole numbers.
  void stretch() {
    if (below(2) == 0) return;
    const double scale = std::exp2(below(20) - 10) / 3, turn = below(100) / 7.0;
    for (Point& p : input_.points)
      p = {scale * (std::cos(turn) * p.x - std::sin(turn) * p.y),
           scale * (std::sin(turn) * p.x + std::cos(turn) * p.y)};
  }

  std::mt19937_64 random_;
  int size_ = 0;
  Pslg input_;
};

double total(const RegionAreas& areas) {
  double sum = 0;
  for (const auto& [region, area] : areas) sum += area;
  return sum;
}

std::string words(const Pslg& input) {
  std::ostringstream text;
  text.precision(17);
  for (const Pslg::Polygon& polygon : input.polygons) {
    text << "region " << polygon.region << '\n';
    for (const Pslg::Ring& ring : polygon.rings) {
      for (const std::int32_t corner : ring)
        text << " (" << input.points[corner].x << ", " << input.points[corner].y << ')';
      text << '\n';
    }
  }
  return text.str();
}

void check_areas(const RegionAreas& actual, const RegionAreas& expected, double tolerance) {
  std::set<std::int32_t> regions;
  for (const auto& areas : {actual, expected})
    for (const auto& [region, area] : areas) regions.insert(region);
  const auto in = [](const RegionAreas& areas, std::int32_t region) {
    const auto at = areas.find(region);
    return at == areas.end() ? 0 : at->second;
  };
  for (const std::int32_t region : regions) {
    CAPTURE(region);
    CHECK(std::abs(in(actual, region) - in(expected, region)) <= tolerance);
  }
}

bool covers_at_most(const Pslg& input, double most) {
  try {
    return total(areas_of(triangulate(input))) <= most;
  } catch (const Error& error) {
    return std::string(error.what()).find("cover no area") != std::string::npos;
  }
}

}  // namespace

TEST_CASE("whatever polygons do to each other, each place belongs to what the rings around it say") {
  std::mt19937_64 random = testing::seeded_generator("polygons");
  std::int64_t empty = 0, regions = 0;
  for (std::int64_t i = 0; testing::more_cases(i, 4000, regions > 1000); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    Pslg input = RandomPolygons(seed).input();
    INFO(words(input));
    const RegionAreas expected = expected_areas(input);
    static_cast<void>(repair(input));
    const double scale = total(expected), extent = Box::of(input.points).high.x - Box::of(input.points).low.x;
    if (scale < 1e-12 * extent * extent) {
      ++empty;
      CHECK(covers_at_most(input, 1e-12 * extent * extent));
      continue;
    }
    regions += expected.size() > 1;
    const RegionAreas actual = areas_of(triangulate(input));
    check_areas(actual, expected, 1e-9 * scale);
    if (i % 4 != 0) continue;
    const Pslg seeded = with_seeds(input);
    CHECK(total(areas_of(triangulate(seeded))) == doctest::Approx(scale).epsilon(1e-9));
  }
  CHECK(empty > 0);
}
