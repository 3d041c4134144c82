#include "decompose/to_decomposition.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/hilbert.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Area, first moments, and area by region, summed over pieces.
struct Moments {
  double area = 0, work = 0, x = 0, y = 0;
  std::map<std::uint16_t, double> by_region;

  void add(const PlanarMap& map, const Piece& piece) {
    const Point o = map.at(map.start(piece.side));
    double px = 0, py = 0;
    SideId h = piece.side;
    do {
      const Point &a = map.at(map.start(h)), &b = map.at(map.end(h));
      const double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
      const double swept = ax * by - ay * bx;
      px += swept * (ax + bx) / 6;
      py += swept * (ay + by) / 6;
      h = map.side(h).next;
    } while (h != piece.side);
    area += piece.area;
    work += piece.work;
    x += px + o.x * piece.area;
    y += py + o.y * piece.area;
    by_region[map.side(piece.side).region] += piece.area;
  }

  [[nodiscard]] Decomposition::Subdomain subdomain() const {
    const auto most = std::max_element(by_region.begin(), by_region.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return {area, work, {x / area, y / area}, most->first};
  }
};

std::vector<SubdomainId> along_hilbert_curve(const std::vector<Decomposition::Subdomain>& subdomains) {
  Point low = subdomains[0].centroid, high = low;
  for (const auto& s : subdomains) {
    low = {std::min(low.x, s.centroid.x), std::min(low.y, s.centroid.y)};
    high = {std::max(high.x, s.centroid.x), std::max(high.y, s.centroid.y)};
  }
  const HilbertOrder order(low, high);
  std::vector<std::pair<std::uint64_t, SubdomainId>> keyed;
  for (std::size_t i = 0; i < subdomains.size(); ++i)
    keyed.emplace_back(order.index(subdomains[i].centroid), static_cast<SubdomainId>(i));
  std::sort(keyed.begin(), keyed.end());
  std::vector<SubdomainId> new_of_old(subdomains.size());
  for (std::size_t k = 0; k < keyed.size(); ++k) new_of_old[at(keyed[k].second)] = static_cast<SubdomainId>(k);
  return new_of_old;
}

void set_subdomains(Decomposition& d, const PlanarMap& map, const std::vector<Piece>& pieces,
                    std::vector<SubdomainId>& group_of, std::int32_t count) {
  std::vector<Moments> moments(at(count));
  for (std::size_t i = 0; i < pieces.size(); ++i) moments[at(group_of[i])].add(map, pieces[i]);
  std::vector<Decomposition::Subdomain> unordered;
  for (const Moments& m : moments) unordered.push_back(m.subdomain());
  const std::vector<SubdomainId> new_of_old = along_hilbert_curve(unordered);
  d.subdomains.resize(at(count));
  for (std::size_t i = 0; i < unordered.size(); ++i) d.subdomains[at(new_of_old[i])] = unordered[i];
  for (SubdomainId& g : group_of) g = new_of_old[at(g)];
}

bool is_kept(const PlanarMap& map, SideId h, SubdomainId left, SubdomainId right) {
  return map.wall(h).kind == PlanarMap::Kind::kInput || left != right;
}

void set_roots(Decomposition& d, const PlanarMap& map, const std::vector<SubdomainId>& subdomain_of) {
  for (SideId h = 0; at(h) < map.sides.size(); h += 2) {
    const PlanarMap::Wall& wall = map.wall(h);
    const SideId s = map.start(h) < map.end(h) ? h : h + 1;  // in ascending direction
    const SubdomainId left = subdomain_of[at(s)], right = subdomain_of[at(PlanarMap::twin(s))];
    if (!is_kept(map, h, left, right)) continue;
    d.roots.push_back({map.start(s), map.end(s), wall.marker, wall.shell, left, right, map.side(s).region,
                       map.side(PlanarMap::twin(s)).region, wall.kind != PlanarMap::Kind::kInput});
  }
}

/// Makes one root again of two that meet where a dropped bridge ended on an input segment.
class Rejoiner {
 public:
  Rejoiner(Decomposition& d, const PlanarMap& map) : d_(d), map_(map), ending_(map.points.size()) {
    for (std::size_t r = 0; r < d.roots.size(); ++r)
      for (const GlobalPointId v : {d.roots[r].a, d.roots[r].b}) ending_[at(v)].push_back(static_cast<RootId>(r));
  }

  void run() {
    for (std::size_t v = 0; v < ending_.size(); ++v)
      if (is_needless(v)) join_at(static_cast<GlobalPointId>(v));
    std::erase_if(d_.roots, [](const Decomposition::Root& r) { return r.a == kNone; });
  }

 private:
  [[nodiscard]] bool is_needless(std::size_t v) const {
    if (map_.origin[v] != kNone || ending_[v].size() != 2) return false;
    return !d_.roots[at(ending_[v][0])].separator && !d_.roots[at(ending_[v][1])].separator;
  }

  void join_at(GlobalPointId v) {
    const RootId kept = ending_[at(v)][0], gone = ending_[at(v)][1];
    Decomposition::Root &root = d_.roots[at(kept)], &rest = d_.roots[at(gone)];
    const GlobalPointId end = rest.a == v ? rest.b : rest.a;
    (root.a == v ? root.a : root.b) = end;
    if (root.a > root.b) {
      std::swap(root.a, root.b);
      std::swap(root.left, root.right);
      std::swap(root.left_region, root.right_region);
    }
    std::replace(ending_[at(end)].begin(), ending_[at(end)].end(), gone, kept);
    rest.a = kNone;
  }

  Decomposition& d_;
  const PlanarMap& map_;
  std::vector<std::vector<RootId>> ending_;  // the roots that end at each point
};

/// Which subdomain each point that no root uses lies in, by a bridge that once led there; kNone for other points.
std::vector<SubdomainId> find_isolated(const Decomposition& d, const PlanarMap& map,
                                       const std::vector<SubdomainId>& subdomain_of) {
  std::vector<SubdomainId> inside(map.points.size(), kNone);
  for (std::size_t h = 0; h < map.sides.size(); ++h) inside[at(map.sides[h].origin)] = subdomain_of[h];
  for (const Decomposition::Root& r : d.roots) inside[at(r.a)] = inside[at(r.b)] = kNone;
  for (std::size_t v = 0; v < inside.size(); ++v)
    if (map.origin[v] == kNone) inside[v] = kNone;
  return inside;
}

void set_points(Decomposition& d, const PlanarMap& map, const std::vector<SubdomainId>& isolated_in) {
  std::vector<bool> used(map.points.size(), false);
  for (const Decomposition::Root& r : d.roots) used[at(r.a)] = used[at(r.b)] = true;
  std::vector<GlobalPointId> new_id(map.points.size(), kNone);
  std::vector<std::pair<SubdomainId, GlobalPointId>> inner;
  for (std::size_t v = 0; v < map.points.size(); ++v) {
    if (!used[v] && isolated_in[v] == kNone) continue;
    new_id[v] = static_cast<GlobalPointId>(d.points.size());
    d.points.push_back(map.points[v]);
    d.origin.push_back(map.origin[v]);
    if (isolated_in[v] != kNone) inner.emplace_back(isolated_in[v], new_id[v]);
  }
  for (Decomposition::Root& r : d.roots) {
    r.a = new_id[at(r.a)];
    r.b = new_id[at(r.b)];
  }
  std::sort(inner.begin(), inner.end());
  d.point_begin.assign(d.size() + 1, 0);
  for (const auto& [subdomain, point] : inner) {
    ++d.point_begin[at(subdomain) + 1];
    d.point_list.push_back(point);
  }
  for (std::size_t i = 0; i < d.size(); ++i) d.point_begin[i + 1] += d.point_begin[i];
}

}  // namespace

Decomposition to_decomposition(const PlanarMap& map, const std::vector<Piece>& pieces,
                               const std::vector<std::int32_t>& group_of, std::int32_t count) {
  Decomposition d;
  std::vector<SubdomainId> group = group_of;
  set_subdomains(d, map, pieces, group, count);
  std::vector<SubdomainId> subdomain_of = label_sides(map, pieces);
  for (SubdomainId& s : subdomain_of)
    if (s != kNone) s = group[at(s)];
  set_roots(d, map, subdomain_of);
  Rejoiner(d, map).run();
  set_points(d, map, find_isolated(d, map, subdomain_of));
  list_roots(d);
  return d;
}

}  // namespace driftmesh
