#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "base/mix.hpp"
#include "protocol/codec.hpp"
#include "protocol/split_set.hpp"

/// A substitute for the mesher: subdomains that share edges, split them at random a limited number of times, and
/// respond to some of their neighbors' splits with more of their own.
namespace driftmesh::protocol::toy {

/// Random numbers that travel with a subdomain: splitmix64.
struct Random {
  std::uint64_t state = 0;
  std::uint64_t next() { return mix(state += kMixStep); }
  std::uint64_t below(std::uint64_t n) { return next() % n; }
  bool chance(std::uint64_t percent) { return below(100) < percent; }
};

struct Edge {
  SubdomainId one, other;
};

/// What all ranks know at the start, drawn from a seed.
struct World {
  World(std::uint64_t from_seed, std::int32_t rank_count) : seed(from_seed), ranks(rank_count) {
    Random random{from_seed * 977 + 5};
    const auto subdomains = 2 + random.below(3 * static_cast<std::uint64_t>(ranks) + 2);
    for (std::uint64_t s = 0; s < subdomains; ++s)
      owners.push_back(static_cast<Rank>(random.below(static_cast<std::uint64_t>(ranks))));
    // A ring, so that every subdomain shares an edge, and some chords.
    for (std::uint64_t s = 0; s < subdomains; ++s) add_edge(s, (s + 1) % subdomains);
    for (auto n = random.below(subdomains + 1); n > 0; --n) {
      const auto a = random.below(subdomains);
      add_edge(a, (a + 1 + random.below(subdomains - 1)) % subdomains);
    }
    aggregation = random.chance(30) ? 1 : 1 + random.below(20);
    splits = random.below(12);
    moves = random.chance(25) ? 0 : random.below(8);
  }
  void add_edge(std::uint64_t a, std::uint64_t b) {
    edges.push_back({static_cast<SubdomainId>(a), static_cast<SubdomainId>(b)});
  }
  [[nodiscard]] WireLimits limits() const {
    return {ranks, static_cast<std::int32_t>(owners.size()), static_cast<std::int32_t>(edges.size())};
  }

  std::uint64_t seed;
  std::int32_t ranks;
  IdVector<SubdomainId, Rank> owners;
  IdVector<GlobalRootId, Edge> edges;
  std::size_t aggregation = 1;
  std::uint64_t splits = 0;  // number that a subdomain makes of its own accord
  std::uint64_t moves = 0;   // number that a rank makes
};

/// How a subdomain treats a received split point; tests replace each function by a wrong one.
struct MeshRules {
  bool replays_ancestors = true;
  bool inserts_again = false;
};

/// One subdomain.
class Subdomain {
 public:
  Subdomain() = default;
  Subdomain(const World& world, SubdomainId id)
      : id_(id), random_{world.seed * 31 + static_cast<std::uint64_t>(to_int(id))} {
    for (const GlobalRootId e : ids_of(world.edges))
      if (world.edges[e].one == id || world.edges[e].other == id) points_[e];
    due_ = world.splits;
    answers_ = world.splits;
  }

  [[nodiscard]] SubdomainId id() const { return id_; }
  [[nodiscard]] bool active() const { return due_ > 0 || !pending_.empty(); }
  [[nodiscard]] bool broken() const { return broken_; }
  void tell(const SplitPoint<GlobalRootId>& split) { pending_.push_back(split); }

  /// The points on each of its edges, in order of arrival.
  using Points = std::map<GlobalRootId, std::vector<dyadic::Path>>;
  [[nodiscard]] const Points& points() const { return points_; }

  /// One unit of work; the messages for its neighbors are appended to `said`.
  void work(const MeshRules& rules, std::vector<SplitPoint<GlobalRootId>>& said) {
    if (!pending_.empty()) {
      const SplitPoint<GlobalRootId> split = pending_.back();
      pending_.pop_back();
      receive(rules, split);
      return;
    }
    --due_;
    auto edge = points_.begin();
    std::advance(edge, static_cast<std::ptrdiff_t>(random_.below(points_.size())));
    dyadic::Path path = dyadic::kWhole;
    while (knows(edge->second, path)) path = 2 * path + random_.below(2);
    if (dyadic::depth(path) > 40) return;
    edge->second.push_back(path);
    said.push_back({edge->first, path});
  }

  [[nodiscard]] Bytes pack() const {
    std::vector<std::uint64_t> words{random_.state, due_, answers_, pending_.size(), points_.size()};
    for (const SplitPoint<GlobalRootId>& split : pending_)
      words.insert(words.end(), {static_cast<std::uint64_t>(to_int(split.root)), split.path});
    for (const auto& [edge, paths] : points_) {
      words.insert(words.end(), {static_cast<std::uint64_t>(to_int(edge)), paths.size()});
      words.insert(words.end(), paths.begin(), paths.end());
    }
    Bytes bytes(words.size() * sizeof(std::uint64_t));
    std::memcpy(bytes.data(), words.data(), bytes.size());
    return bytes;
  }

  Subdomain(SubdomainId id, const Bytes& bytes) : id_(id) {
    std::vector<std::uint64_t> words(bytes.size() / sizeof(std::uint64_t));
    std::memcpy(words.data(), bytes.data(), bytes.size());
    auto word = words.begin();
    random_.state = *word++;
    due_ = *word++;
    answers_ = *word++;
    const auto pending = *word++, edges = *word++;
    for (std::uint64_t i = 0; i < pending; ++i, word += 2)
      pending_.push_back({static_cast<GlobalRootId>(word[0]), word[1]});
    for (std::uint64_t i = 0; i < edges; ++i) {
      auto& paths = points_[static_cast<GlobalRootId>(*word++)];
      const auto count = static_cast<std::ptrdiff_t>(*word++);
      paths.assign(word, word + count);
      word += count;
    }
  }

 private:
  static bool knows(const std::vector<dyadic::Path>& paths, dyadic::Path path) {
    return std::find(paths.begin(), paths.end(), path) != paths.end();
  }

  void receive(const MeshRules& rules, const SplitPoint<GlobalRootId>& split) {
    auto& paths = points_[split.root];
    bool news = false;
    for (int up = dyadic::depth(split.path); up >= 0; --up) {
      const dyadic::Path path = split.path >> up;
      if (up > 0 && !rules.replays_ancestors) continue;
      if (knows(paths, path) && !(up == 0 && rules.inserts_again)) continue;
      if (path != dyadic::kWhole && !knows(paths, path >> 1)) broken_ = true;  // no interval to put the point on
      paths.push_back(path);
      news = true;
    }
    if (news && answers_ > 0 && random_.chance(60)) --answers_, ++due_;
  }

  SubdomainId id_{};
  Random random_;
  std::uint64_t due_ = 0;      // splits to be made
  std::uint64_t answers_ = 0;  // splits that may become due by what the neighbors do
  bool broken_ = false;
  std::vector<SplitPoint<GlobalRootId>> pending_;
  Points points_;
};

}  // namespace driftmesh::protocol::toy
