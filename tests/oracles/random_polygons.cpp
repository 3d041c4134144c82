#include "oracles/random_polygons.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <random>
#include <set>
#include <utility>

namespace driftmesh::oracles {
namespace {

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed * 0x9e3779b97f4a7c15U + 1) {}

  RandomPolygons make() {
    set_.general = below(2) == 0;
    size_ = set_.general ? std::int64_t{1} << 20 : 4 + below(7);
    place_grid();
    const std::int64_t count = 1 + below(4);
    for (std::int64_t p = 0; p < count; ++p) set_.polygons.push_back(set_.general ? stars() : any_polygon());
    for (GridPolygon& polygon : set_.polygons)
      if (below(3) > 0) polygon.region = static_cast<double>(1 + below(3));
    return std::move(set_);
  }

 private:
  std::int64_t below(std::int64_t limit) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(limit));
  }
  double part() { return static_cast<double>(below(1 << 20)) / (1 << 20); }

  void place_grid() {
    switch (below(3)) {
      case 0:  // meters, in UTM
        set_.unit = set_.general ? 0x1p-6 : 4;
        set_.origin = {static_cast<std::int64_t>(500'000 / set_.unit),
                       static_cast<std::int64_t>(4'100'000 / set_.unit)};
        break;
      case 1:  // as small as degrees
        set_.unit = set_.general ? 0x1p-20 : 0x1p-4;
        set_.origin = {static_cast<std::int64_t>(-76 / set_.unit), static_cast<std::int64_t>(37 / set_.unit)};
        break;
      default:
        set_.unit = set_.general ? 0x1p-10 : 1;
        set_.origin = {-size_ / 2, -size_ / 2};
    }
  }

  // ---- Flawed ones ---------------------------------------------------------------------------------------------

  GridPoint any_point() { return {below(size_ + 1), below(size_ + 1)}; }

  GridPolygon any_polygon() {
    GridPolygon polygon;
    const std::int64_t rings = 1 + below(6) / 2;
    for (std::int64_t r = 0; r < rings; ++r) polygon.rings.push_back(any_ring());
    return polygon;
  }

  /// With at least three different corners: other rings are no rings.
  GridRing any_ring() {
    for (;;) {
      const GridRing ring = any_corners_in_a_row();
      if (std::set(ring.begin(), ring.end()).size() >= 3) return ring;
    }
  }

  GridRing any_corners_in_a_row() {
    GridRing ring;
    switch (below(6)) {
      case 0:
        ring = any_corners(3 + below(5));
        break;
      case 1:
        ring = keyhole();
        break;
      case 2:
        ring = around_its_middle();
        break;
      default:
        ring = any_rectangle();
    }
    switch (below(12)) {
      case 0:
        repeat_a_corner(ring);
        break;
      case 1:
        add_spike(ring);
        break;
      case 2:
        visit_a_corner_again(ring);
        break;
      default:
        break;
    }
    if (below(4) == 0) std::ranges::reverse(ring);
    return ring;
  }

  GridRing any_corners(std::int64_t count) {
    GridRing ring;
    for (std::int64_t i = 0; i < count; ++i) ring.push_back(any_point());
    return ring;
  }

  /// Seldom flat.
  GridRing any_rectangle() {
    const GridPoint a = any_point();
    GridPoint b = any_point();
    for (int tries = 0; tries < 3 && (a.x == b.x || a.y == b.y); ++tries) b = any_point();
    return rectangle(a, b);
  }
  static GridRing rectangle(const GridPoint& a, const GridPoint& b) { return {a, {b.x, a.y}, b, {a.x, b.y}}; }

  /// A rectangle, a way inward, a rectangle within, and the way back.
  GridRing keyhole() {
    const GridPoint a = any_point(), b = any_point();
    GridRing ring = rectangle(a, b);
    const GridRing inner =
        rectangle({(2 * a.x + b.x) / 3, (2 * a.y + b.y) / 3}, {(a.x + 2 * b.x) / 3, (a.y + 2 * b.y) / 3});
    ring.push_back(ring.front());
    for (const std::size_t k : {0, 3, 2, 1, 0}) ring.push_back(inner[k]);
    return ring;
  }

  GridRing around_its_middle() {
    GridRing ring = any_corners(4 + below(5));
    double x = 0, y = 0;
    for (const GridPoint& p : ring) {
      x += static_cast<double>(p.x) / static_cast<double>(ring.size());
      y += static_cast<double>(p.y) / static_cast<double>(ring.size());
    }
    std::ranges::sort(ring, {}, [&](const GridPoint& p) {
      return std::atan2(static_cast<double>(p.y) - y, static_cast<double>(p.x) - x);
    });
    return ring;
  }

  void insert(GridRing& ring, std::int64_t at, const GridPoint& p) { ring.insert(ring.begin() + at, p); }
  std::int64_t place_in(const GridRing& ring) { return below(static_cast<std::int64_t>(ring.size())); }

  void repeat_a_corner(GridRing& ring) {
    const std::int64_t at = place_in(ring);
    insert(ring, at, GridPoint(ring[static_cast<std::size_t>(at)]));
  }
  void add_spike(GridRing& ring) {
    const std::int64_t at = place_in(ring);
    const GridPoint corner = ring[static_cast<std::size_t>(at)];
    insert(ring, at, any_point());
    insert(ring, at, corner);
  }
  void visit_a_corner_again(GridRing& ring) {
    const GridPoint corner = ring[static_cast<std::size_t>(place_in(ring))];
    insert(ring, place_in(ring), corner);
  }

  // ---- Valid ones ----------------------------------------------------------------------------------------------

  GridRing star(double x, double y, double radius, std::int64_t corners) {
    GridRing ring;
    for (std::int64_t i = 0; i < corners; ++i) {
      const double angle =
          2 * std::numbers::pi * (static_cast<double>(i) + 0.1 + 0.8 * part()) / static_cast<double>(corners);
      const double r = radius * (0.5 + 0.5 * part());
      ring.push_back({std::llround(x + r * std::cos(angle)), std::llround(y + r * std::sin(angle))});
    }
    return ring;
  }

  /// Stars of five and more corners around a disk of a quarter of their radius hold the holes, which are apart.
  GridPolygon stars() {
    const double size = static_cast<double>(size_), x = size * part(), y = size * part(),
                 radius = size * (0.1 + 0.4 * part());
    GridPolygon polygon{{star(x, y, radius, 5 + below(8))}, {}};
    const std::int64_t holes = below(4);
    for (std::int64_t h = 0; h < holes; ++h) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(h) + part() / 8) / 3;
      polygon.rings.push_back(
          star(x + 0.07 * radius * std::cos(angle), y + 0.07 * radius * std::sin(angle), 0.05 * radius, 3 + below(5)));
    }
    return polygon;
  }

  std::mt19937_64 random_;
  std::int64_t size_ = 0;
  RandomPolygons set_;
};

// ---- Traits ------------------------------------------------------------------------------------------------------

int turn(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const std::int64_t det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}
bool on_edge(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  return turn(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}
bool cross(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}
const GridPoint& after(const GridRing& ring, std::size_t i) {
  return ring[(i + 1) % ring.size()];
}
bool on_ring(const GridRing& ring, const GridPoint& p) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (on_edge(ring[i], after(ring, i), p)) return true;
  return false;
}
bool inside(const GridRing& ring, const GridPoint& p) {
  bool odd = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint &a = ring[i], &b = after(ring, i);
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const GridPoint &low = a.y < b.y ? a : b, &high = a.y < b.y ? b : a;
    if (turn(low, high, p) > 0) odd = !odd;
  }
  return odd && !on_ring(ring, p);
}

struct Meeting {
  bool crosses = false, touches = false, coincides = false, holds = false;
};

Meeting meeting_of(const GridRing& r, const GridRing& s) {
  Meeting meeting;
  for (std::size_t i = 0; i < r.size(); ++i) {
    for (std::size_t j = 0; j < s.size(); ++j) {
      const GridPoint &a = r[i], &b = after(r, i), &c = s[j], &d = after(s, j);
      meeting.crosses |= cross(a, b, c, d);
      if (a == b || c == d || turn(a, b, c) != 0 || turn(a, b, d) != 0) continue;
      meeting.coincides |= std::max(std::min(a, b), std::min(c, d)) < std::min(std::max(a, b), std::max(c, d));
    }
    meeting.touches |= on_ring(s, r[i]);
    meeting.holds |= inside(s, r[i]);
  }
  for (const GridPoint& p : s) {
    meeting.touches |= on_ring(r, p);
    meeting.holds |= inside(r, p);
  }
  return meeting;
}

class Traits {
 public:
  void look_at_ring(const GridRing& ring) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (ring[i] == after(ring, i)) set(Trait::repeated_corner);
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        const GridPoint &a = ring[i], &b = after(ring, i), &c = ring[j], &d = after(ring, j);
        if (cross(a, b, c, d)) set(Trait::ring_crosses_itself);
        if (a != b && ((a == c && b == d) || (a == d && b == c))) set(Trait::keyhole);
        if (c != a && c != b && on_edge(a, b, c)) set(Trait::ring_touches_itself);
        if (j > i + 1 && a == c) set(Trait::ring_touches_itself);
      }
    }
  }

  void look_at_polygon(const GridPolygon& polygon) {
    for (std::size_t h = 1; h < polygon.rings.size(); ++h) {
      const Meeting meeting = meeting_of(polygon.rings[0], polygon.rings[h]);
      if (meeting.crosses) set(Trait::hole_crosses);
      if (meeting.touches) set(Trait::hole_touches);
      for (const GridPoint& p : polygon.rings[h])
        if (!inside(polygon.rings[0], p) && !on_ring(polygon.rings[0], p)) set(Trait::hole_leaves);
      for (std::size_t g = 1; g < h; ++g) {
        const Meeting holes = meeting_of(polygon.rings[g], polygon.rings[h]);
        if (holes.crosses || holes.holds) set(Trait::holes_overlap);
        if (holes.touches) set(Trait::holes_touch);
      }
    }
  }

  void look_at_pair(const GridPolygon& p, const GridPolygon& q) {
    const Meeting meeting = meeting_of(p.rings[0], q.rings[0]);
    if (meeting.crosses || meeting.holds) set(Trait::polygons_overlap);
    if (meeting.touches) set(Trait::polygons_touch);
    if (meeting.coincides) set(Trait::edges_coincide);
    for (const auto& [one, other] : {std::pair(&p, &q), std::pair(&q, &p)})
      for (std::size_t h = 1; h < one->rings.size(); ++h)
        for (const GridPoint& corner : other->rings[0])
          if (inside(one->rings[h], corner)) set(Trait::over_a_hole);
  }

  [[nodiscard]] const std::array<bool, kTraits>& found() const { return found_; }

 private:
  void set(Trait trait) { found_[static_cast<std::size_t>(trait)] = true; }
  std::array<bool, kTraits> found_{};
};

std::string coordinates(const RandomPolygons& set, const GridPoint& p) {
  std::array<char, 80> text{};
  const auto at = [&](std::int64_t origin, std::int64_t x) { return static_cast<double>(origin + x) * set.unit; };
  std::snprintf(text.data(), text.size(), "[%.17g,%.17g]", at(set.origin.x, p.x), at(set.origin.y, p.y));
  return text.data();
}

}  // namespace

RandomPolygons make_random_polygons(std::uint64_t seed) {
  return Maker(seed).make();
}

const char* trait_name(Trait trait) {
  constexpr std::array<const char*, kTraits> kNames{
      "polygons overlap", "polygons touch",      "edges coincide", "over a hole",  "repeated corner",
      "touches itself",   "ring crosses itself", "keyhole",        "hole crosses", "hole touches",
      "hole leaves",      "holes overlap",       "holes touch"};
  return kNames[static_cast<std::size_t>(trait)];
}

std::array<bool, kTraits> traits_of(const std::vector<GridPolygon>& polygons) {
  Traits traits;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    for (const GridRing& ring : polygons[p].rings) traits.look_at_ring(ring);
    traits.look_at_polygon(polygons[p]);
    for (std::size_t q = 0; q < p; ++q) traits.look_at_pair(polygons[p], polygons[q]);
  }
  return traits.found();
}

std::string geojson_of(const RandomPolygons& set) {
  std::string text =
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:32618"}},"features":[)";
  for (const GridPolygon& polygon : set.polygons) {
    if (&polygon != &set.polygons.front()) text += ",\n";
    text += R"({"type":"Feature","properties":{)";
    if (polygon.region) text += "\"region\":" + std::to_string(static_cast<int>(*polygon.region));
    text += R"(},"geometry":{"type":"Polygon","coordinates":[)";
    for (const GridRing& ring : polygon.rings) {
      text += &ring == &polygon.rings.front() ? "[" : ",[";
      for (const GridPoint& p : ring) text += coordinates(set, p) + ",";
      text += coordinates(set, ring.front()) + "]";
    }
    text += "]}}";
  }
  return text + "]}\n";
}

}  // namespace driftmesh::oracles
