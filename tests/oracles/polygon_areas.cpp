#include "oracles/polygon_areas.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace driftmesh::oracles {
namespace {

namespace mp = boost::multiprecision;

/// Fractions of integers of a fixed width, which are compared and not reduced.
template <class Int>
struct Fraction {
  Int num = 0, den = 1;  // den > 0
  long double rounded = 0;

  Fraction() = default;
  Fraction(Int n, Int d) : num(std::move(n)), den(std::move(d)) {
    if (den < 0) {
      num = -num;
      den = -den;
    }
    rounded = static_cast<long double>(num) / static_cast<long double>(den);
  }

  /// By the rounded values where they differ by far more than their rounding.
  [[nodiscard]] bool operator<(const Fraction& other) const {
    const long double gap = other.rounded - rounded;
    if (std::fabs(gap) > 1e-15L * (std::fabs(rounded) + std::fabs(other.rounded))) return gap > 0;
    return num * other.den < other.num * den;
  }
  [[nodiscard]] bool operator==(const Fraction& other) const { return !(*this < other) && !(other < *this); }
};

template <class Int>
class Slabs {
 public:
  explicit Slabs(const std::vector<GridPolygon>& polygons) : polygons_(polygons) {
    for (std::size_t p = 0; p < polygons.size(); ++p)
      for (std::size_t r = 0; r < polygons[p].rings.size(); ++r) {
        const GridRing& ring = polygons[p].rings[r];
        for (std::size_t i = 0; i < ring.size(); ++i) add_edge(ring[i], ring[(i + 1) % ring.size()], p, r);
      }
  }

  PolygonAreas run() {
    list_heights();
    for (std::size_t i = 1; i < heights_.size(); ++i) take_slab(heights_[i - 1], heights_[i]);
    return areas_;
  }

 private:
  using Ratio = Fraction<Int>;
  struct Edge {
    GridPoint low, high;
    std::size_t polygon, ring;
  };
  struct Cut {  // an edge meets the middle of a slab
    Ratio x;
    const Edge* edge;
  };

  void add_edge(const GridPoint& a, const GridPoint& b, std::size_t polygon, std::size_t ring) {
    for (const GridPoint& p : {a, b}) heights_.push_back({Int(p.y), Int(1)});
    if (a.y != b.y) edges_.push_back(a.y < b.y ? Edge{a, b, polygon, ring} : Edge{b, a, polygon, ring});
  }

  static Int cross(const Int& ax, const Int& ay, const Int& bx, const Int& by) { return ax * by - ay * bx; }

  void list_heights() {
    for (std::size_t i = 0; i < edges_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) add_crossing(edges_[i], edges_[j]);
    std::sort(heights_.begin(), heights_.end());
    heights_.erase(std::unique(heights_.begin(), heights_.end()), heights_.end());
  }

  void add_crossing(const Edge& e, const Edge& f) {
    if (e.high.y <= f.low.y || f.high.y <= e.low.y) return;
    if (std::max(e.low.x, e.high.x) < std::min(f.low.x, f.high.x) ||
        std::max(f.low.x, f.high.x) < std::min(e.low.x, e.high.x))
      return;
    const Int ex = Int(e.high.x) - e.low.x, ey = Int(e.high.y) - e.low.y;
    const Int fx = Int(f.high.x) - f.low.x, fy = Int(f.high.y) - f.low.y;
    const Int across = cross(ex, ey, fx, fy);
    if (across == 0) return;
    const Int along = cross(Int(f.low.x) - e.low.x, Int(f.low.y) - e.low.y, fx, fy);  // on e, in units of `across`
    const Ratio t(along, across);
    if (t.num <= 0 || t.num >= t.den) return;
    heights_.push_back({Int(e.low.y) * t.den + ey * t.num, t.den});
  }

  void take_slab(const Ratio& low, const Ratio& high) {
    const Ratio middle(low.num * high.den + high.num * low.den, 2 * low.den * high.den);
    std::vector<Cut> cuts;
    for (const Edge& edge : edges_) {
      const Ratio bottom(Int(edge.low.y), 1), top(Int(edge.high.y), 1);
      if (!(bottom < middle && middle < top)) continue;
      const Int dx = Int(edge.high.x) - edge.low.x, dy = Int(edge.high.y) - edge.low.y;
      cuts.push_back(
          {Ratio(Int(edge.low.x) * dy * middle.den + (middle.num - middle.den * edge.low.y) * dx, dy * middle.den),
           &edge});
    }
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.x < b.x; });
    take_cuts(cuts, high.rounded - low.rounded);
  }

  void take_cuts(const std::vector<Cut>& cuts, long double height) {
    std::vector<std::vector<char>> inside;
    for (const GridPolygon& polygon : polygons_) inside.emplace_back(polygon.rings.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      if (i > 0 && cuts[i - 1].x < cuts[i].x) add(inside, height * (cuts[i].x.rounded - cuts[i - 1].x.rounded));
      char& side = inside[cuts[i].edge->polygon][cuts[i].edge->ring];
      side = side == 0 ? 1 : 0;
    }
  }

  void add(const std::vector<std::vector<char>>& inside, long double area) {
    bool covered = false;
    double region = 0;
    for (std::size_t p = 0; p < polygons_.size(); ++p) {
      if (inside[p].empty() || inside[p][0] == 0 || std::count(inside[p].begin() + 1, inside[p].end(), 1) > 0) continue;
      covered = true;
      if (polygons_[p].region) region = *polygons_[p].region;
    }
    if (!covered) return;
    areas_.total += area;
    areas_.regions[region] += area;
  }

  const std::vector<GridPolygon>& polygons_;
  std::vector<Edge> edges_;  // but horizontal ones
  std::vector<Ratio> heights_;
  PolygonAreas areas_;
};

template <unsigned Bits>
using Fixed = mp::number<mp::cpp_int_backend<Bits, Bits, mp::signed_magnitude, mp::unchecked, void>, mp::et_off>;

}  // namespace

// With coordinates from 0 to 2^b, heights have numerators below 2^(3 b + 5) and denominators below 2^(2 b + 3); those
// of middles are below 2^(5 b + 9) and 2^(4 b + 7), of cuts 2^(6 b + 12) and 2^(5 b + 8), and products of these, which
// are compared, below 2^(11 b + 20).
PolygonAreas covered_areas(const std::vector<GridPolygon>& polygons) {
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  GridPoint low{kNone, kNone};
  std::vector<GridPolygon> moved = polygons;  // to 0, which costs no digits
  const auto for_each_corner = [&](const auto& visit) {
    for (GridPolygon& polygon : moved)
      for (GridRing& ring : polygon.rings) std::ranges::for_each(ring, visit);
  };
  for_each_corner([&](const GridPoint& p) { low = {std::min(low.x, p.x), std::min(low.y, p.y)}; });
  std::int64_t largest = 0;
  for_each_corner([&](GridPoint& p) {
    p = {p.x - low.x, p.y - low.y};
    largest = std::max({largest, p.x, p.y});
  });
  if (largest < 512) return Slabs<Fixed<128>>(moved).run();
  if (largest < (std::int64_t{1} << 44)) return Slabs<Fixed<512>>(moved).run();
  return Slabs<Fixed<640>>(moved).run();
}

}  // namespace driftmesh::oracles
