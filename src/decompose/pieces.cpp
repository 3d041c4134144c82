#include "decompose/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "decompose/graph_partition.hpp"
#include "decompose/outline.hpp"
#include "decompose/work.hpp"
#include "geometry/hilbert_sort.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// Sets of pieces that touch along walls: the connected parts of the domain.
DisjointSets<PieceId> connected_parts(const PlanarMap& map, const IdVector<SideId, PieceId>& piece_of,
                                      std::size_t pieces) {
  DisjointSets<PieceId> sets(pieces);
  for (const WallId w : ids_of(map.walls)) {
    const SideId h = PlanarMap::first_side(w);
    const PieceId left = piece_of[h], right = piece_of[PlanarMap::twin(h)];
    if (left != kNone && right != kNone) sets.join(left, right);
  }
  return sets;
}

/// A connected part of the domain.
struct DomainPart {
  std::vector<PieceId> pieces;
  double work = 0;
};

std::vector<DomainPart> parts_of_domain(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces) {
  DisjointSets<PieceId> sets = connected_parts(map, label_sides(map, pieces), pieces.size());
  IdVector<PieceId, DomainPart> part_of(pieces.size());
  for (const PieceId i : ids_of(pieces)) {
    DomainPart& part = part_of[sets.find(i)];
    part.pieces.push_back(i);
    part.work += pieces[i].work;
  }
  std::erase_if(part_of, [](const DomainPart& part) { return part.pieces.empty(); });
  return {part_of.begin(), part_of.end()};
}

/// Sorts parts along a Hilbert curve, each by some point of its border.
void sort_along_curve(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces, std::span<DomainPart> parts) {
  std::vector<Point> places;
  for (const DomainPart& part : parts) places.push_back(map.at(map.start(pieces[part.pieces.front()].side)));
  std::vector<DomainPart> sorted;
  for (const std::size_t i : in_hilbert_order(places)) sorted.push_back(std::move(parts[i]));
  std::ranges::move(sorted, parts.begin());
}

/// Cuts a sequence of at least `bundles` parts into that many runs of about equal work, none of which is empty.
void deal_in_order(std::span<const DomainPart> parts, double work, std::int32_t bundles,
                   IdVector<PieceId, Piece>& pieces) {
  double before = 0;
  std::int32_t bundle = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto due = static_cast<std::int32_t>((before + parts[k].work / 2) / work * bundles);
    const bool must = parts.size() - k == to_index(bundles - bundle - 1);  // one is left for each bundle that follows
    if (k > 0 && (must || due > bundle)) bundle = std::min(bundle + 1, bundles - 1);
    for (const PieceId i : parts[k].pieces) pieces[i].bundle = bundle;
    before += parts[k].work;
  }
}

/// Divides `total` by weight into integers, each at least `least`, by the method of largest remainders.
std::vector<std::int32_t> round_shares(const std::vector<double>& weights, std::int32_t total, std::int32_t least) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<std::int32_t> shares;
  std::vector<std::pair<double, std::size_t>> by_rest;  // largest remainder first
  std::int32_t dealt = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double due = total * (weights[i] / sum);
    shares.push_back(std::max(least, static_cast<std::int32_t>(due)));
    dealt += shares.back();
    by_rest.emplace_back(shares.back() - due, i);
  }
  std::sort(by_rest.begin(), by_rest.end());
  for (std::size_t k = 0; dealt < total; k = (k + 1) % by_rest.size(), ++dealt) ++shares[by_rest[k].second];
  for (std::size_t k = by_rest.size(); dealt > total; k = k > 1 ? k - 1 : by_rest.size()) {
    std::int32_t& share = shares[by_rest[k - 1].second];
    if (share <= least) continue;
    --share;
    --dealt;
  }
  return shares;
}

/// Pieces as vertices, weighted by work; edges weighted by the length of the walls between two pieces.
WeightedGraph graph_of(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces) {
  const IdVector<SideId, PieceId> piece_of = label_sides(map, pieces);
  std::map<std::pair<PieceId, PieceId>, double> shared;
  for (const SideId h : ids_of(map.sides)) {
    const PieceId left = piece_of[h], right = piece_of[PlanarMap::twin(h)];
    if (left == kNone || right == kNone || left == right) continue;
    shared[{left, right}] += std::sqrt(squared_distance(map.at(map.start(h)), map.at(map.end(h))));
  }
  WeightedGraph graph;
  graph.begin.assign(pieces.size() + 1, 0);
  for (const auto& [pair, length] : shared) {
    ++graph.begin[to_int(pair.first) + 1];
    graph.neighbor.push_back(to_int(pair.second));
    graph.edge_weight.push_back(length);
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  for (const Piece& p : pieces) graph.vertex_weight.push_back(p.work);
  return graph;
}

template <class Visit>
void for_each_edge(const WeightedGraph& graph, Visit&& visit) {
  for (const std::int32_t v : ids_of(graph.vertex_weight))
    for (std::int32_t k = graph.begin[v]; k < graph.begin[v + 1]; ++k) visit(PieceId{v}, PieceId{graph.neighbor[k]});
}

/// Groups of pieces, lightest first, with their adjacent groups.
class Groups {
 public:
  using GroupId = PieceId;  ///< one of its pieces

  explicit Groups(const WeightedGraph& graph)
      : sets_(graph.size()), work_(graph.vertex_weight.begin(), graph.vertex_weight.end()), touching_(graph.size()) {
    for (const GroupId i : ids_of(work_)) by_work_.emplace(work_[i], i);
    for_each_edge(graph, [&](PieceId v, PieceId w) { touching_[v].insert(w); });
  }

  [[nodiscard]] std::size_t count() const { return by_work_.size() + finished_; }

  /// Joins the lightest group that has a neighbor with its lightest one. False if no two groups touch.
  bool join_lightest() {
    while (!by_work_.empty()) {
      const GroupId group = by_work_.begin()->second;
      by_work_.erase(by_work_.begin());
      const GroupId other = lightest_neighbor(group);
      if (other != kNone) {
        join(group, other);
        return true;
      }
      ++finished_;
    }
    return false;
  }

  /// Joins the groups of two pieces, if they are different.
  void join_pieces(PieceId piece, PieceId other) {
    const GroupId group = sets_.find(piece), second = sets_.find(other);
    if (group == second) return;
    by_work_.erase({work_[group], group});
    join(group, second);
  }

  GroupId group_of(PieceId piece) { return sets_.find(piece); }

 private:
  GroupId lightest_neighbor(GroupId group) {
    GroupId best = kNone;
    for (const GroupId n : touching_[group])
      if (best == kNone || work_[n] < work_[best]) best = n;
    return best;
  }

  void join(GroupId group, GroupId other) {
    by_work_.erase({work_[other], other});
    sets_.join(group, other);
    const GroupId kept = sets_.find(group), gone = kept == group ? other : group;
    work_[kept] += work_[gone];
    for (const GroupId n : touching_[gone]) {
      touching_[n].erase(gone);
      if (n == kept) continue;
      touching_[n].insert(kept);
      touching_[kept].insert(n);
    }
    touching_[gone].clear();
    by_work_.emplace(work_[kept], kept);
  }

  DisjointSets<PieceId> sets_;
  IdVector<GroupId, double> work_;
  IdVector<GroupId, std::set<GroupId>> touching_;
  std::set<std::pair<double, GroupId>> by_work_;
  std::size_t finished_ = 0;
};

/// If there are many more pieces than groups, METIS partitions them. Its parts need not be connected, so their
/// connected components become the groups. Nothing is joined if too few groups would be left.
void join_by_partition(const WeightedGraph& graph, std::int32_t count, Groups& groups) {
  const IdVector<PieceId, std::int32_t> part(
      partition_graph(graph, std::vector<double>(to_index(count), 1.0),
                      count <= 8 ? PartitionMethod::kRecursive : PartitionMethod::kDirect));
  Groups joined = groups;
  for_each_edge(graph, [&](PieceId v, PieceId w) {
    if (part[v] == part[w]) joined.join_pieces(v, w);
  });
  if (joined.count() >= to_index(count)) groups = std::move(joined);
}

/// METIS, which halves again and again, complains on standard output where that leaves nothing for one side.
bool can_be_halved(const WeightedGraph& graph) {
  const auto& weights = graph.vertex_weight;
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  return 2 * *std::ranges::max_element(weights) < all;
}

void join_bundles(const IdVector<PieceId, Piece>& pieces, Groups& groups) {
  std::map<std::int32_t, PieceId> first;
  for (const PieceId i : ids_of(pieces)) {
    if (pieces[i].bundle == kNone) continue;
    const auto [entry, is_new] = first.try_emplace(pieces[i].bundle, i);
    if (!is_new) groups.join_pieces(entry->second, i);
  }
}

}  // namespace

IdVector<SideId, PieceId> label_sides(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces) {
  IdVector<SideId, PieceId> piece_of(map.sides.size(), kNone);
  for (const PieceId i : ids_of(pieces)) {
    SideId h = pieces[i].side;
    do {
      piece_of[h] = i;
      h = map.side(h).next;
    } while (h != pieces[i].side);
  }
  return piece_of;
}

IdVector<PieceId, Piece> find_pieces(const PlanarMap& map, const SizeBounds& sizes) {
  IdVector<PieceId, Piece> pieces;
  IdVector<SideId, bool> seen(map.sides.size(), false);
  Loop loop;
  for (const SideId first : ids_of(map.sides)) {
    if (seen[first] || !map.side(first).in_domain()) continue;
    read_loop(map, first, loop);
    for (const LoopSide& s : loop) seen[s.side] = true;
    Piece piece;
    piece.side = first;
    piece.area = area_inside(loop);
    piece.work = piece.area * work_density(sizes, map.side(first).region);
    pieces.push_back(piece);
  }
  return pieces;
}

std::int32_t bundle_small_parts(const PlanarMap& map, IdVector<PieceId, Piece>& pieces, std::int32_t subdomains) {
  std::vector<DomainPart> parts = parts_of_domain(map, pieces);
  if (parts.size() <= to_index(subdomains)) return 0;
  double work = 0;
  for (const DomainPart& part : parts) work += part.work;
  // Those that deserve a subdomain of their own come first, fewer than there are subdomains.
  const double mean = work / subdomains;
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.work > b.work; });
  std::size_t large = 0;
  for (double rest = work; large + 1 < to_index(subdomains) && parts[large].work >= mean && rest > mean; ++large)
    rest -= parts[large].work;
  const std::span<DomainPart> small = std::span(parts).subspan(large);
  double small_work = 0;
  for (const DomainPart& part : small) small_work += part.work;
  const std::int32_t most = subdomains - static_cast<std::int32_t>(large);
  const std::int32_t bundles =
      large == 0 ? most : std::clamp(static_cast<std::int32_t>(std::lround(small_work / mean)), 1, most);
  sort_along_curve(map, pieces, small);
  deal_in_order(small, small_work, bundles, pieces);
  return bundles;
}

void allot_parts(const PlanarMap& map, IdVector<PieceId, Piece>& pieces, std::int32_t parts) {
  std::vector<DomainPart> whole = parts_of_domain(map, pieces);
  std::erase_if(whole, [&](const DomainPart& part) { return pieces[part.pieces.front()].bundle != kNone; });
  if (whole.empty()) return;
  std::vector<double> work;
  for (const DomainPart& part : whole) work.push_back(part.work);
  const std::vector<std::int32_t> of_part = round_shares(work, parts, 1);
  for (std::size_t p = 0; p < whole.size(); ++p) {
    work.clear();
    for (const PieceId i : whole[p].pieces) work.push_back(pieces[i].work);
    const std::vector<std::int32_t> shares = round_shares(work, of_part[p], 0);
    for (std::size_t k = 0; k < shares.size(); ++k) pieces[whole[p].pieces[k]].parts = shares[k];
  }
}

IdVector<PieceId, SubdomainId> group_pieces(const PlanarMap& map, const IdVector<PieceId, Piece>& pieces,
                                            std::int32_t count) {
  if (pieces.size() <= to_index(count)) {
    const IdRange<SubdomainId> each(pieces.size());
    return {each.begin(), each.end()};
  }
  const WeightedGraph graph = graph_of(map, pieces);
  Groups groups(graph);
  join_bundles(pieces, groups);
  if (pieces.size() > 2 * to_index(count) && can_partition_graphs() && can_be_halved(graph))
    join_by_partition(graph, count, groups);
  while (groups.count() > to_index(count) && groups.join_lightest()) {
  }
  IdVector<PieceId, SubdomainId> number(pieces.size(), kNoSubdomain), group_of;
  std::int32_t numbers = 0;
  for (const PieceId i : ids_of(number)) {
    SubdomainId& n = number[groups.group_of(i)];
    if (n == kNoSubdomain) n = SubdomainId{numbers++};
    group_of.push_back(n);
  }
  return group_of;
}

}  // namespace driftmesh
