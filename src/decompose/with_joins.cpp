#include "decompose/with_joins.hpp"

#include <array>
#include <utility>
#include <vector>

#include "geometry/midpoint.hpp"

namespace driftmesh {
namespace {

class Joining {
 public:
  Joining(const Decomposition& d, const IdVector<SubdomainId, SubdomainId>& group)
      : d_(d), group_(group), chains_(d.roots.begin(), d.roots.end()) {
    number_subdomains();
    set_sides();
    list_ends();
    for (std::size_t i = d.points.size(); i-- > 0;) fuse_at(static_cast<GlobalPointId>(i));
  }

  JoinedSubdomains take() {
    number_points();
    number_roots();
    list_roots(made_.decomposition);
    return std::move(made_);
  }

 private:
  /// A root, or two that have become one.
  struct Chain {
    Chain(const Decomposition::Root& r) : root(r) {}
    Decomposition::Root root;
    std::array<GlobalRootId, 2> half{kNone, kNone};
    GlobalPointId middle = kNoPoint;
    bool stands = true;  ///< it is neither gone nor part of another one
  };

  void number_subdomains() {
    auto& made = made_.decomposition.subdomains;
    IdVector<SubdomainId, double> largest;
    made_.whole.assign(d_.size(), kNoSubdomain);
    for (const SubdomainId s : ids_of(d_.subdomains)) {
      const Decomposition::Subdomain& part = d_.subdomains[s];
      if (group_[s] == s) {
        made_.whole[s] = made.next_id();
        made.push_back(part);
        largest.push_back(part.area);
        continue;
      }
      const SubdomainId whole = made_.whole[s] = made_.whole[group_[s]];
      Decomposition::Subdomain& all = made[whole];
      const double share = part.area / (all.area + part.area);
      all.centroid.x += share * (part.centroid.x - all.centroid.x);
      all.centroid.y += share * (part.centroid.y - all.centroid.y);
      all.area += part.area;
      all.predicted += part.predicted;
      if (part.area > largest[whole]) {
        largest[whole] = part.area;
        all.region = part.region;
      }
    }
  }

  void set_sides() {
    for (Chain& chain : chains_) {
      Decomposition::Root& root = chain.root;
      chain.stands = !root.separator || group_[root.left] != group_[root.right];
      for (SubdomainId* side : {&root.left, &root.right})
        if (*side != kNoSubdomain) *side = made_.whole[*side];
    }
  }

  void list_ends() {
    ends_.resize(d_.points.size());
    for (const GlobalRootId r : ids_of(chains_))
      if (chains_[r].stands)
        for (const GlobalPointId v : {chains_[r].root.a, chains_[r].root.b}) ends_[v].add(r);
  }

  /// A root in the direction that begins with point `start`.
  static Decomposition::Root directed(Decomposition::Root root, GlobalPointId start) {
    if (root.a != start) root.turn_around();
    return root;
  }

  /// Intervals have higher points than those that contain them: what has been halved last is whole first.
  void fuse_at(GlobalPointId middle) {
    if (ends_[middle].count != 2 || d_.origin[middle] != kNone) return;
    auto [r, s] = ends_[middle].root;
    const auto other_end = [&](GlobalRootId one) {
      return chains_[one].root.a == middle ? chains_[one].root.b : chains_[one].root.a;
    };
    if (other_end(r) > other_end(s)) std::swap(r, s);
    const GlobalPointId a = other_end(r), b = other_end(s);
    Decomposition::Root first = directed(chains_[r].root, a), second = directed(chains_[s].root, middle);
    if (a == b || first.shell != kNone || second.shell != kNone) return;
    if (!(midpoint(d_.points[a], d_.points[b]) == d_.points[middle])) return;
    first.b = second.b;
    second.a = first.a;
    if (!(first == second)) return;
    const GlobalRootId fused = chains_.next_id();
    chains_.push_back(first);
    chains_[fused].half = {r, s};
    chains_[fused].middle = middle;
    chains_[r].stands = chains_[s].stands = false;
    ends_[a].replace(r, fused);
    ends_[b].replace(s, fused);
  }

  /// Points at which only separators have ended go, but for those of the input, which are inside then.
  void number_points() {
    made_.points.resize(d_.points.size());
    IdVector<GlobalPointId, SubdomainId> inside(d_.points.size(), kNoSubdomain);
    for (const SubdomainId s : ids_of(d_.subdomains))
      for (const GlobalPointId v : d_.inner_points_of(s)) inside[v] = made_.whole[s];
    IdVector<GlobalPointId, bool> stays(d_.points.size(), false);
    for (const Chain& chain : chains_)
      for (const GlobalPointId v : {chain.root.a, chain.root.b}) {
        if (chain.stands) stays[v] = true;
        if (ends_[v].count == 0 && d_.origin[v] != kNone) inside[v] = chain.root.left;
      }
    std::vector<std::pair<SubdomainId, GlobalPointId>> inner;
    for (const GlobalPointId v : ids_of(d_.points)) {
      if (!stays[v] && inside[v] == kNoSubdomain) continue;
      const GlobalPointId now = made_.points[v].point = made_.decomposition.points.next_id();
      made_.decomposition.points.push_back(d_.points[v]);
      made_.decomposition.origin.push_back(d_.origin[v]);
      if (inside[v] != kNoSubdomain) inner.emplace_back(inside[v], now);
    }
    list_inner_points(made_.decomposition, std::move(inner));
  }

  void number_roots() {
    made_.roots.assign(d_.roots.size(), {dyadic::kWhole, kNone});
    IdVector<GlobalRootId, GlobalRootId> above(chains_.size(), kNone);
    for (const GlobalRootId r : ids_of(chains_))
      for (const GlobalRootId half : chains_[r].half)
        if (half != kNone) above[half] = r;
    for (const GlobalRootId r : ids_of(d_.roots)) {
      GlobalRootId top = r;
      while (above[top] != kNone) top = above[top];
      if (!chains_[top].stands || made_.roots[r].root != kNone) continue;
      Decomposition::Root root = chains_[top].root;
      note_intervals(top, root.a, dyadic::kWhole, made_.decomposition.roots.next_id());
      root.a = made_.points[root.a].point;
      root.b = made_.points[root.b].point;
      made_.decomposition.roots.push_back(root);
    }
  }

  /// What chain r, seen from `start`, is of a new root.
  void note_intervals(GlobalRootId r, GlobalPointId start, dyadic::Path path, GlobalRootId root) {
    const Chain& chain = chains_[r];
    if (chain.middle == kNoPoint) {
      made_.roots[r] = {path, root};
      return;
    }
    made_.points[chain.middle].halved = {path, root};
    const bool forward = chain.root.a == start;
    note_intervals(chain.half[forward ? 0 : 1], start, dyadic::first_half(path), root);
    note_intervals(chain.half[forward ? 1 : 0], chain.middle, dyadic::second_half(path), root);
  }

  /// The chains that end at a point, if they are two.
  struct Ends {
    void add(GlobalRootId r) {
      if (count < 2) root[to_index(count)] = r;
      ++count;
    }
    void replace(GlobalRootId r, GlobalRootId with) {
      for (GlobalRootId& one : root)
        if (one == r) one = with;
    }
    std::int32_t count = 0;
    std::array<GlobalRootId, 2> root{kNone, kNone};
  };

  const Decomposition& d_;
  const IdVector<SubdomainId, SubdomainId>& group_;
  IdVector<GlobalRootId, Chain> chains_;
  IdVector<GlobalPointId, Ends> ends_;
  JoinedSubdomains made_;
};

}  // namespace

JoinedSubdomains with_joins(const Decomposition& decomposition, const IdVector<SubdomainId, SubdomainId>& group) {
  return Joining(decomposition, group).take();
}

}  // namespace driftmesh
