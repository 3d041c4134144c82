#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "decompose/decomposition.hpp"
#include "migration/subdomain.hpp"

namespace driftmesh::testing {

/// What happened to subdomains besides refinement.
struct Unrest {
  int pauses = 0;              ///< breaks in the middle of refinement
  int slept = 0;               ///< fell asleep
  int moved = 0;               ///< packed and unpacked awake
  int moved_asleep = 0;        ///< the same asleep
  int woken = 0;               ///< subdomains woken by a point on an interface
  int told_after_waking = 0;   ///< got a point in a later round than one that had woken them
  int told_without_sleep = 0;  ///< got a point after they had met their bounds, awake
};

/// Subdomains refined in rounds, as by RefinementInRounds: each meets its bounds, then all are told of the points on
/// interfaces. With a seed, they are paused, packed and unpacked, and put to sleep at random.
class RestlessRounds {
 public:
  struct Told {
    SubdomainId to{};
    GlobalRootId root{};
    dyadic::Path path = 0;
    friend auto operator<=>(const Told&, const Told&) = default;
  };

  /// `seed` 0: nothing happens but refinement. The context must outlive the object.
  RestlessRounds(const SubdomainContext& context, std::uint64_t seed)
      : context_(context), restless_(seed != 0), random_(seed) {}

  void add(SubdomainId id) { subdomains_.emplace(id, Subdomain(id, context_)); }
  void add(const Bytes& packed) {
    Subdomain subdomain = Subdomain::unpack(packed, context_, Source::kThisRun);
    const SubdomainId id = subdomain.id();
    subdomains_.emplace(id, std::move(subdomain));
  }
  /// Takes one out, packed.
  [[nodiscard]] Bytes remove(SubdomainId id) { return subdomains_.extract(id).mapped().pack(); }

  /// All meet their bounds. Returns what neighbors have to be told.
  [[nodiscard]] std::vector<Told> refine() {
    std::vector<Told> told;
    for (auto& [id, subdomain] : subdomains_) {
      for (const SplitPoint<GlobalRootId>& split : finish(subdomain))
        told.push_back({context_.decomposition->roots[split.root].across_from(id), split.root, split.path});
      disturb(subdomain);
    }
    return told;
  }
  /// Tells the subdomains that are here, in the order of roots and paths whoever said it.
  void tell(std::vector<Told> told) {
    std::ranges::sort(told);
    told.erase(std::unique(told.begin(), told.end()), told.end());
    for (const Told& t : told)
      if (const auto place = subdomains_.find(t.to); place != subdomains_.end()) tell(place->second, t);
  }
  /// Rounds until nothing is told, of subdomains that are all here.
  void run() {
    for (std::vector<Told> told = refine(); !told.empty(); told = refine()) tell(std::move(told));
  }

  /// The complete state of each subdomain, in the one form that says nothing of its history.
  [[nodiscard]] std::map<SubdomainId, Bytes> states() {
    std::map<SubdomainId, Bytes> states;
    for (auto& [id, subdomain] : subdomains_) {
      subdomain.sleep();
      states.emplace(id, subdomain.pack());
    }
    return states;
  }
  [[nodiscard]] const Unrest& unrest() const { return unrest_; }
  [[nodiscard]] std::int64_t triangles() const {
    std::int64_t sum = 0;
    for (const auto& [id, subdomain] : subdomains_) sum += subdomain.triangles();
    return sum;
  }

 private:
  [[nodiscard]] bool happens(std::uint64_t once_in) { return restless_ && random_() % once_in == 0; }

  std::vector<SplitPoint<GlobalRootId>> finish(Subdomain& subdomain) {
    std::vector<SplitPoint<GlobalRootId>> said;
    while (subdomain.active()) {
      const bool briefly = happens(2);
      subdomain.work(briefly ? static_cast<std::int64_t>(1 + random_() % 50) : INT64_MAX, said);
      unrest_.pauses += subdomain.active();
      if (happens(4)) move(subdomain);
    }
    return said;
  }

  void disturb(Subdomain& subdomain) {
    if (subdomain.dormant()) return;
    if (happens(2)) {
      subdomain.sleep();
      ++unrest_.slept;
    }
    if (happens(4)) move(subdomain);
    if (happens(8)) {  // sleeps badly
      subdomain.wake();
      if (happens(2)) subdomain.sleep();
    }
  }

  void move(Subdomain& subdomain) {
    ++(subdomain.dormant() ? unrest_.moved_asleep : unrest_.moved);
    subdomain = Subdomain::unpack(subdomain.pack(), context_, Source::kThisRun);
  }

  void tell(Subdomain& subdomain, const Told& told) {
    const bool was_active = subdomain.active();
    subdomain.tell({told.root, told.path});
    if (was_active || !subdomain.active()) return;
    unrest_.told_after_waking += woken_.contains(subdomain.id());
    if (subdomain.dormant()) {
      ++unrest_.woken;
      woken_.insert(subdomain.id());
    } else {
      ++unrest_.told_without_sleep;
    }
  }

  const SubdomainContext& context_;
  bool restless_;
  std::mt19937_64 random_;
  std::map<SubdomainId, Subdomain> subdomains_;
  std::set<SubdomainId> woken_;
  Unrest unrest_;
};

}  // namespace driftmesh::testing
