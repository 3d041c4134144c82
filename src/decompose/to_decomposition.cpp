#include "decompose/to_decomposition.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/hilbert_sort.hpp"

namespace driftmesh {
namespace {

/// Area, first moments, and area by region, summed over pieces.
struct Moments {
  struct RegionArea {
    std::uint16_t region;
    double area;
  };
  double area = 0, work = 0, x = 0, y = 0;
  RegionArea first{0, -1};  // the only one in most subdomains
  std::vector<RegionArea> others;

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
    add(map.side(piece.side).region, piece.area);
  }

  void add(std::uint16_t region, double more) {
    if (first.area < 0) first = {region, 0};
    RegionArea* found = first.region == region ? &first : nullptr;
    for (RegionArea& other : others)
      if (other.region == region) found = &other;
    if (found == nullptr) {
      others.push_back({region, 0});
      found = &others.back();
    }
    found->area += more;
  }

  [[nodiscard]] Decomposition::Subdomain subdomain() const {
    RegionArea most = first;
    for (const RegionArea& other : others)
      if (other.area > most.area || (other.area == most.area && other.region < most.region)) most = other;
    return {area, work, {x / area, y / area}, most.region};
  }
};

IdVector<SubdomainId, SubdomainId> along_hilbert_curve(
    const IdVector<SubdomainId, Decomposition::Subdomain>& subdomains) {
  std::vector<Point> centroids;
  for (const auto& s : subdomains) centroids.push_back(s.centroid);
  IdVector<SubdomainId, SubdomainId> new_of_old(subdomains.size());
  std::int32_t next = 0;
  for (const std::size_t old : in_hilbert_order(centroids))
    new_of_old[static_cast<SubdomainId>(old)] = SubdomainId{next++};
  return new_of_old;
}

void set_subdomains(Decomposition& d, const PlanarMap& map, const IdVector<PieceId, Piece>& pieces,
                    IdVector<PieceId, SubdomainId>& group_of, std::int32_t count) {
  IdVector<SubdomainId, Moments> moments(to_index(count));
  for (const PieceId i : ids_of(pieces)) moments[group_of[i]].add(map, pieces[i]);
  IdVector<SubdomainId, Decomposition::Subdomain> unordered;
  for (const Moments& m : moments) unordered.push_back(m.subdomain());
  const IdVector<SubdomainId, SubdomainId> new_of_old = along_hilbert_curve(unordered);
  d.subdomains.resize(unordered.size());
  for (const SubdomainId i : ids_of(unordered)) d.subdomains[new_of_old[i]] = unordered[i];
  for (SubdomainId& g : group_of) g = new_of_old[g];
}

/// Until set_points, the points of the decomposition are those of the map.
GlobalPointId to_global(MapVertexId v) {
  return GlobalPointId{to_int(v)};
}
MapVertexId in_map(GlobalPointId v) {
  return MapVertexId{to_int(v)};
}

bool is_kept(const PlanarMap& map, SideId h, SubdomainId left, SubdomainId right) {
  return map.wall(h).kind == PlanarMap::Kind::kInput || left != right;
}

void set_roots(Decomposition& d, const PlanarMap& map, const IdVector<SideId, SubdomainId>& subdomain_of) {
  d.roots.reserve(map.walls.size());
  for (const WallId w : ids_of(map.walls)) {
    const PlanarMap::Wall& wall = map.walls[w];
    const SideId h = PlanarMap::first_side(w);
    const bool directed = wall.shell != kNone;  // away from its apex, like all of its shell
    const SideId s = directed || map.start(h) < map.end(h) ? h : PlanarMap::twin(h);
    const SubdomainId left = subdomain_of[s], right = subdomain_of[PlanarMap::twin(s)];
    if (!is_kept(map, h, left, right)) continue;
    d.roots.push_back({to_global(map.start(s)), to_global(map.end(s)), wall.marker, wall.shell, left, right,
                       map.side(s).region, map.side(PlanarMap::twin(s)).region, wall.kind != PlanarMap::Kind::kInput});
  }
}

/// Before set_points: rejoins two roots that meet where a dropped bridge ended on an input segment.
class Rejoiner {
 public:
  Rejoiner(Decomposition& d, const PlanarMap& map) : d_(d), map_(map), ending_(map.points.size()) {
    for (const GlobalRootId r : ids_of(d.roots))
      for (const GlobalPointId v : {d.roots[r].a, d.roots[r].b}) ending_[v].add(r);
  }

  void run() {
    for (const GlobalPointId v : ids_of(ending_))
      if (is_needless(v)) join_at(v);
    std::erase_if(d_.roots, [](const Decomposition::Root& r) { return r.a == kNoPoint; });
  }

 private:
  /// The roots that end at a point: two of them, which are all where it matters.
  struct Ending {
    std::int32_t count = 0;
    std::array<GlobalRootId, 2> some{};
    void add(GlobalRootId root) {
      if (count < 2) some[static_cast<std::size_t>(count)] = root;
      ++count;
    }
  };

  [[nodiscard]] bool is_needless(GlobalPointId v) const {
    if (map_.origin[in_map(v)] != kNone || ending_[v].count != 2) return false;
    return !d_.roots[ending_[v].some[0]].separator && !d_.roots[ending_[v].some[1]].separator;
  }

  void join_at(GlobalPointId v) {
    const auto [kept, gone] = ending_[v].some;
    Decomposition::Root &root = d_.roots[kept], &rest = d_.roots[gone];
    const GlobalPointId end = rest.a == v ? rest.b : rest.a;
    (root.a == v ? root.a : root.b) = end;
    if (root.a > root.b) root.turn_around();
    std::ranges::replace(ending_[end].some, gone, kept);
    rest.a = kNoPoint;
  }

  Decomposition& d_;
  const PlanarMap& map_;
  IdVector<GlobalPointId, Ending> ending_;
};

/// The subdomain of each point that is on no root, known from a former bridge to it; kNoSubdomain for other points.
IdVector<GlobalPointId, SubdomainId> find_isolated(const Decomposition& d, const PlanarMap& map,
                                                   const IdVector<SideId, SubdomainId>& subdomain_of) {
  IdVector<GlobalPointId, SubdomainId> inside(map.points.size(), kNoSubdomain);
  for (const SideId h : ids_of(map.sides)) inside[to_global(map.start(h))] = subdomain_of[h];
  for (const Decomposition::Root& r : d.roots) inside[r.a] = inside[r.b] = kNoSubdomain;
  for (const GlobalPointId v : ids_of(inside))
    if (map.origin[in_map(v)] == kNone) inside[v] = kNoSubdomain;
  return inside;
}

void set_points(Decomposition& d, const PlanarMap& map, const IdVector<GlobalPointId, SubdomainId>& isolated_in) {
  IdVector<GlobalPointId, bool> used(map.points.size(), false);
  for (const Decomposition::Root& r : d.roots) used[r.a] = used[r.b] = true;
  IdVector<GlobalPointId, GlobalPointId> new_id(map.points.size(), kNoPoint);
  d.points.reserve(map.points.size());
  d.origin.reserve(map.points.size());
  std::vector<std::pair<SubdomainId, GlobalPointId>> inner;
  for (const GlobalPointId v : ids_of(used)) {
    if (!used[v] && isolated_in[v] == kNoSubdomain) continue;
    new_id[v] = d.points.next_id();
    d.points.push_back(map.points[in_map(v)]);
    d.origin.push_back(map.origin[in_map(v)]);
    if (isolated_in[v] != kNoSubdomain) inner.emplace_back(isolated_in[v], new_id[v]);
  }
  for (Decomposition::Root& r : d.roots) {
    r.a = new_id[r.a];
    r.b = new_id[r.b];
  }
  list_inner_points(d, std::move(inner));
}

}  // namespace

Decomposition to_decomposition(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces,
                               IdVector<PieceId, SubdomainId> group_of, std::int32_t count) {
  Decomposition d;
  set_subdomains(d, map, pieces, group_of, count);
  IdVector<SideId, SubdomainId> subdomain_of;
  subdomain_of.reserve(map.sides.size());
  for (const PieceId piece : label_sides(map, pieces))
    subdomain_of.push_back(piece == kNone ? kNoSubdomain : group_of[piece]);
  set_roots(d, map, subdomain_of);
  Rejoiner(d, map).run();
  set_points(d, map, find_isolated(d, map, subdomain_of));
  list_roots(d);
  return d;
}

}  // namespace driftmesh
