#include "decompose/star_cost.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

// Costs of loads are lengths in units of a subdomain's size.
constexpr double kUneven = 0.6;      ///< cost per squared deviation from the mean
constexpr double kOver = 16;         ///< cost per squared excess over kMostMoved
constexpr double kLeastLoad = 0.65;  ///< a load is smaller only if it was before
/// The weight of separators inside a subdomain, which will be dropped: something, so that they do not run wild.
constexpr double kInner = 0.01;

double cost_of_load(double load) {
  const double over = std::max(0.0, load - StarCost::kMostMoved);
  return kUneven * (load - 1) * (load - 1) + kOver * over * over;
}

}  // namespace

Loads::Loads(const IdVector<PieceId, Piece>& pieces, const IdVector<PieceId, SubdomainId>& groups,
             std::int32_t subdomains)
    : group_of(groups), load(to_index(subdomains), 0), size(to_index(subdomains), 0) {
  double work = 0;
  for (const PieceId i : ids_of(pieces)) {
    work += pieces[i].work;
    load[group_of[i]] += pieces[i].work;
    size[group_of[i]] += pieces[i].area;
  }
  mean = work / subdomains;
  for (double& l : load) l /= mean;
  for (double& s : size) s = std::sqrt(s);
}

void StarCost::set(const Loads& loads, double most_load) {
  most_load_ = most_load;
  count_ = 0;
  size_ = kNever;
  const auto sectors = star_.sectors();
  for (std::size_t k = 0; k < sectors.size(); ++k) {
    const PieceId piece = sectors[k].piece;
    const Star::Spoke &from = star_.spokes()[k], &to = star_.after(k);
    weight_[k] = from.separates ? 1 : 0;
    if (piece == kNone) continue;
    const SubdomainId s = loads.group_of[piece];
    if (from.separates && loads.group_of[piece_of_[PlanarMap::twin(from.side)]] == s) weight_[k] = kInner;
    neighbor_of_[k] = neighbor(loads, s);
    density_[k] = pieces_[piece].work / (pieces_[piece].area * loads.mean);
    Point& slope = neighbors_[neighbor_of_[k]].slope;
    slope.x += 0.5 * density_[k] * (from.end.y - to.end.y);
    slope.y -= 0.5 * density_[k] * (from.end.x - to.end.x);
    size_ = std::min(size_, loads.size[s]);
  }
}

std::size_t StarCost::neighbor(const Loads& loads, SubdomainId subdomain) {
  std::size_t i = 0;
  while (i < count_ && neighbors_[i].subdomain != subdomain) ++i;
  if (i == count_) neighbors_[count_++] = {subdomain, loads.size[subdomain], loads.load[subdomain], 0, {0, 0}};
  return i;
}

double StarCost::at_present() const {
  double cost = 0;
  const auto spokes = star_.spokes();
  for (std::size_t k = 0; k < spokes.size(); ++k)
    cost += weight_[k] * std::sqrt(squared_distance(spokes[k].end, spokes[k].start));
  for (std::size_t i = 0; i < count_; ++i) cost += neighbors_[i].size * cost_of_load(neighbors_[i].before);
  return cost;
}

double StarCost::at(const Point& p) {
  double cost = 0;
  for (std::size_t i = 0; i < count_; ++i) neighbors_[i].load = neighbors_[i].before;
  for (std::size_t k = 0; k < star_.spokes().size(); ++k) {
    cost += weight_[k] * std::sqrt(squared_distance(star_.spokes()[k].end, p));
    if (star_.sectors()[k].piece != kNone) neighbors_[neighbor_of_[k]].load += density_[k] * star_.growth(k, p);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const Neighbor& n = neighbors_[i];
    if (n.load > std::max(most_load_, n.before) || n.load < std::min(kLeastLoad, n.before)) return kNever;
    cost += n.size * cost_of_load(n.load);
  }
  return cost;
}

void StarCost::Slopes::add(const Point& u, double first, double second) {
  x += first * u.x;
  y += first * u.y;
  xx += second * u.x * u.x;
  xy += second * u.x * u.y;
  yy += second * u.y * u.y;
}

StarCost::Slopes StarCost::slopes(const Point& p) const {
  Slopes sum;
  for (std::size_t k = 0; k < star_.spokes().size(); ++k) {
    if (weight_[k] == 0) continue;
    const Point& end = star_.spokes()[k].end;
    const double length = std::sqrt(squared_distance(end, p));
    const Point u{(p.x - end.x) / length, (p.y - end.y) / length};
    const double bend = weight_[k] / length;
    sum.add(u, weight_[k], -bend);
    sum.xx += bend;
    sum.yy += bend;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const Neighbor& n = neighbors_[i];
    const double over = std::max(0.0, n.load - kMostMoved);
    sum.add(n.slope, 2 * n.size * (kUneven * (n.load - 1) + kOver * over),
            2 * n.size * (over > 0 ? kUneven + kOver : kUneven));
  }
  return sum;
}

Point StarCost::step(const Point& p) const {
  Slopes s = slopes(p);
  if (star_.freedom() == Star::Freedom::kSlides) {
    const Point u = star_.along();
    const double slope = s.x * u.x + s.y * u.y, bend = s.xx * u.x * u.x + 2 * s.xy * u.x * u.y + s.yy * u.y * u.y;
    const double length = bend > 0 ? -slope / bend : 0;
    return {length * u.x, length * u.y};
  }
  const double little = 0.05 * (s.xx + s.yy);  // the cost need not bend in all directions
  s.xx += little;
  s.yy += little;
  const double determinant = s.xx * s.yy - s.xy * s.xy;
  if (!(determinant > 0)) return {0, 0};
  return {(s.xy * s.y - s.yy * s.x) / determinant, (s.xy * s.x - s.xx * s.y) / determinant};
}

void StarCost::move(const Point& p, IdVector<PieceId, Piece>& pieces, Loads& loads) const {
  for (std::size_t k = 0; k < star_.sectors().size(); ++k) {
    const PieceId piece = star_.sectors()[k].piece;
    if (piece == kNone) continue;
    const double growth = star_.growth(k, p);
    pieces[piece].area += growth;
    pieces[piece].work += density_[k] * growth * loads.mean;
    loads.load[loads.group_of[piece]] += density_[k] * growth;
  }
}

}  // namespace driftmesh
