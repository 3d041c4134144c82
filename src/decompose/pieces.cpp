#include "decompose/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "decompose/graph_partition.hpp"
#include "decompose/outline.hpp"
#include "decompose/work.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// Sets of pieces that touch along walls: the connected parts of the domain.
DisjointSets<PieceId> connected_parts(const PlanarMap& map, const IdVector<SideId, PieceId>& piece_of,
                                      std::size_t pieces) {
  DisjointSets sets(pieces);
  for (SideId h = 0; map.sides.has(h); h += 2)
    if (piece_of[h] != kNone && piece_of[h + 1] != kNone) sets.join(piece_of[h], piece_of[h + 1]);
  return sets;
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
WeightedGraph graph_of(const PlanarMap& map, const std::vector<Piece>& pieces) {
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
    ++graph.begin[pair.first + 1];
    graph.neighbor.push_back(pair.second);
    graph.edge_weight.push_back(length);
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  for (const Piece& p : pieces) graph.vertex_weight.push_back(p.work);
  return graph;
}

template <class Visit>
void for_each_edge(const WeightedGraph& graph, Visit&& visit) {
  for (const std::int32_t v : ids_of(graph.vertex_weight))
    for (std::int32_t k = graph.begin[v]; k < graph.begin[v + 1]; ++k) visit(v, graph.neighbor[k]);
}

/// Groups of pieces, lightest first, with their adjacent groups.
class Groups {
 public:
  explicit Groups(const WeightedGraph& graph)
      : sets_(graph.size()), work_(graph.vertex_weight), touching_(graph.size()) {
    for (const std::int32_t i : ids_of(work_)) by_work_.emplace(work_[i], i);
    for_each_edge(graph, [&](std::int32_t v, std::int32_t w) { touching_[v].insert(w); });
  }

  [[nodiscard]] std::size_t count() const { return by_work_.size() + finished_; }

  /// Joins the lightest group that has a neighbor with its lightest one. False if no two groups touch.
  bool join_lightest() {
    while (!by_work_.empty()) {
      const std::int32_t group = by_work_.begin()->second;
      by_work_.erase(by_work_.begin());
      const std::int32_t other = lightest_neighbor(group);
      if (other != kNone) {
        join(group, other);
        return true;
      }
      ++finished_;
    }
    return false;
  }

  /// Joins the groups of two adjacent pieces, if they are different.
  void join_pieces(std::int32_t piece, std::int32_t other) {
    const std::int32_t group = sets_.find(piece), second = sets_.find(other);
    if (group == second) return;
    by_work_.erase({work_[group], group});
    join(group, second);
  }

  std::int32_t group_of(std::int32_t piece) { return sets_.find(piece); }

 private:
  std::int32_t lightest_neighbor(std::int32_t group) {
    std::int32_t best = kNone;
    for (const std::int32_t n : touching_[group])
      if (best == kNone || work_[n] < work_[best]) best = n;
    return best;
  }

  void join(std::int32_t group, std::int32_t other) {
    by_work_.erase({work_[other], other});
    sets_.join(group, other);
    const std::int32_t kept = sets_.find(group), gone = kept == group ? other : group;
    work_[kept] += work_[gone];
    for (const std::int32_t n : touching_[gone]) {
      touching_[n].erase(gone);
      if (n == kept) continue;
      touching_[n].insert(kept);
      touching_[kept].insert(n);
    }
    touching_[gone].clear();
    by_work_.emplace(work_[kept], kept);
  }

  DisjointSets<std::int32_t> sets_;
  IdVector<std::int32_t, double> work_;
  IdVector<std::int32_t, std::set<std::int32_t>> touching_;
  std::set<std::pair<double, std::int32_t>> by_work_;
  std::size_t finished_ = 0;
};

/// If there are many more pieces than groups, METIS partitions them. Its parts need not be connected, so their
/// connected components become the groups. Nothing is joined if METIS leaves parts empty.
void join_by_partition(const WeightedGraph& graph, std::int32_t count, Groups& groups) {
  const IdVector<PieceId, std::int32_t> part =
      partition_graph(graph, std::vector<double>(to_index(count), 1.0),
                      count <= 8 ? PartitionMethod::kRecursive : PartitionMethod::kDirect);
  DisjointSets sets(graph.size());
  std::size_t left = graph.size();
  for_each_edge(graph, [&](std::int32_t v, std::int32_t w) { left -= part[v] == part[w] && sets.join(v, w); });
  if (left < to_index(count)) return;
  for_each_edge(graph, [&](std::int32_t v, std::int32_t w) {
    if (part[v] == part[w]) groups.join_pieces(v, w);
  });
}

}  // namespace

IdVector<SideId, PieceId> label_sides(const PlanarMap& map, const std::vector<Piece>& pieces) {
  IdVector<SideId, PieceId> piece_of(map.sides.size(), kNone);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    SideId h = pieces[i].side;
    do {
      piece_of[h] = static_cast<PieceId>(i);
      h = map.side(h).next;
    } while (h != pieces[i].side);
  }
  return piece_of;
}

std::vector<Piece> find_pieces(const PlanarMap& map, const QualityBounds& bounds) {
  std::vector<Piece> pieces;
  IdVector<SideId, bool> seen(map.sides.size(), false);
  for (const SideId first : ids_of(map.sides)) {
    if (seen[first] || !map.side(first).in_domain()) continue;
    for (SideId h = first; !seen[h]; h = map.side(h).next) seen[h] = true;
    Piece piece;
    piece.side = first;
    piece.area = measure_piece(map, first).area;
    piece.work = piece.area * work_density(bounds, map.side(first).region);
    pieces.push_back(piece);
  }
  return pieces;
}

void allot_parts(const PlanarMap& map, std::vector<Piece>& pieces, std::int32_t parts) {
  DisjointSets sets = connected_parts(map, label_sides(map, pieces), pieces.size());
  IdVector<PieceId, std::vector<std::size_t>> members(pieces.size());
  for (const PieceId i : ids_of(members)) members[sets.find(i)].push_back(to_index(i));
  std::erase_if(members, [](const auto& m) { return m.empty(); });
  if (members.size() > to_index(parts))
    throw Error("the domain consists of " + std::to_string(members.size()) +
                " disconnected parts: it cannot be cut into " + std::to_string(parts) +
                " connected subdomains; ask for at least " + std::to_string(members.size()));
  std::vector<double> work;
  for (const auto& part : members) {
    work.push_back(0);
    for (const std::size_t i : part) work.back() += pieces[i].work;
  }
  const std::vector<std::int32_t> of_part = round_shares(work, parts, 1);
  for (std::size_t p = 0; p < members.size(); ++p) {
    work.clear();
    for (const std::size_t i : members[p]) work.push_back(pieces[i].work);
    const std::vector<std::int32_t> shares = round_shares(work, of_part[p], 0);
    for (std::size_t k = 0; k < shares.size(); ++k) pieces[members[p][k]].parts = shares[k];
  }
}

std::vector<std::int32_t> group_pieces(const PlanarMap& map, const std::vector<Piece>& pieces, std::int32_t count) {
  std::vector<std::int32_t> group_of(pieces.size());
  std::iota(group_of.begin(), group_of.end(), 0);
  if (pieces.size() <= to_index(count)) return group_of;
  const WeightedGraph graph = graph_of(map, pieces);
  Groups groups(graph);
  if (pieces.size() > 2 * to_index(count)) join_by_partition(graph, count, groups);
  while (groups.count() > to_index(count) && groups.join_lightest()) {
  }
  IdVector<PieceId, std::int32_t> number(pieces.size(), kNone);
  std::int32_t numbers = 0;
  for (const PieceId i : ids_of(number)) {
    std::int32_t& n = number[groups.group_of(i)];
    if (n == kNone) n = numbers++;
    group_of[to_index(i)] = n;
  }
  return group_of;
}

}  // namespace driftmesh
