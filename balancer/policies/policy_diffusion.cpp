#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "balancer/snapshot/partners.hpp"
#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"

namespace driftmesh::balancer {
namespace {

/// One rank's part of one round of diffusion. It sees itself and its partners as if they were alone: those that would
/// finish later than on average have a surplus, which goes to the others as each lacks work. Of this it makes the moves
/// from itself.
class Round {
 public:
  Round(const LoadSnapshot& snapshot, Rank self, double rate)
      : snapshot_(snapshot),
        self_(self),
        rate_(rate),
        speeds_(assumed_speeds(snapshot.ranks)),
        touching_(touching_ranks()),
        remaining_(snapshot.ranks[self].remaining) {
    for (const Rank r : distant_partners(self, static_cast<std::int32_t>(snapshot.ranks.size()))) group_.insert(r);
    group_.insert(touching_.begin(), touching_.end());
    group_.insert(self);
    double work = 0, speed = 0;
    for (const Rank r : group_) work += snapshot.ranks[r].remaining, speed += speeds_[r];
    mean_time_ = work / speed;
  }

  std::vector<Move> moves() {
    if (surplus(self_) <= 0) return {};
    double surpluses = 0;
    for (const Rank r : group_) surpluses += std::max(0.0, surplus(r));
    for (const Rank taker : takers()) {
      owed_ += rate_ * -surplus(taker) * surplus(self_) / surpluses;
      give_to(taker);
    }
    return moves_;
  }

 private:
  [[nodiscard]] std::set<Rank> touching_ranks() const {
    std::set<Rank> touching;
    for (const SubdomainLoad& s : snapshot_.subdomains)
      if (s.owner == self_)
        for (const Neighbor& n : (*snapshot_.layout)[s.id].neighbors) touching.insert(owner_of(snapshot_, n.subdomain));
    return touching;
  }

  [[nodiscard]] double time(Rank r) const { return snapshot_.ranks[r].remaining / speeds_[r]; }
  /// Work beyond what this rank can do in the mean time of the group.
  [[nodiscard]] double surplus(Rank r) const { return snapshot_.ranks[r].remaining - mean_time_ * speeds_[r]; }

  /// Adjacent ranks come first, so that borders stay short; then those that would finish early.
  [[nodiscard]] std::vector<Rank> takers() const {
    std::vector<Rank> takers;
    for (const Rank r : group_)
      if (surplus(r) < 0) takers.push_back(r);
    std::ranges::stable_sort(takers, {}, [&](Rank r) { return std::pair(!touching_.contains(r), time(r)); });
    return takers;
  }

  /// Gives what is owed in whole subdomains, rounded, but never so much that `taker` would finish later than this rank.
  void give_to(Rank taker) {
    double given = 0;
    for (const SubdomainLoad& s : easiest_first(taker)) {
      const double then = time(taker) + (given + s.remaining) / speeds_[taker];
      if (s.remaining / 2 > owed_ || then >= (remaining_ - s.remaining) / speeds_[self_]) continue;
      given += s.remaining;
      owed_ -= s.remaining;
      remaining_ -= s.remaining;
      taken_[s.id] = taker;
      moves_.push_back({s.id, taker});
    }
  }

  [[nodiscard]] Rank planned_owner(SubdomainId id) const {
    const auto taken = taken_.find(id);
    return taken != taken_.end() ? taken->second : owner_of(snapshot_, id);
  }

  // All that is here but what is worked on now: what is light; of this what has most of its border with `taker` and
  // least with what stays.
  [[nodiscard]] std::vector<SubdomainLoad> easiest_first(Rank taker) const {
    std::map<SubdomainId, double> attachment;
    std::vector<SubdomainLoad> own;
    for (const SubdomainLoad& s : snapshot_.subdomains) {
      if (s.owner != self_ || s.turn == 0 || s.fixed || taken_.contains(s.id)) continue;
      own.push_back(s);
      for (const Neighbor& n : (*snapshot_.layout)[s.id].neighbors) {
        const Rank owner = planned_owner(n.subdomain);
        attachment[s.id] += owner == taker ? n.length : owner == self_ ? -n.length : 0;
      }
    }
    std::sort(own.begin(), own.end(), [&](const SubdomainLoad& a, const SubdomainLoad& b) {
      const double one = attachment[a.id], other_one = attachment[b.id];
      if (one == other_one || weight_class(a) != weight_class(b)) return leaves_before(a, b);
      return one > other_one;
    });
    return own;
  }

  const LoadSnapshot& snapshot_;
  Rank self_;
  double rate_;
  IdVector<Rank, double> speeds_;
  std::set<Rank> touching_;
  std::set<Rank> group_;  // self, and its partners
  double mean_time_;
  double remaining_;  // here, after moves_
  double owed_ = 0;   // work that the takers were not given yet
  std::map<SubdomainId, Rank> taken_;
  std::vector<Move> moves_;
};

/// Work flows from ranks that would finish later than on average among their partners to those that would finish
/// earlier. Partners are adjacent ranks, which diffusion on a mesh has (Cybenko 1989), and a few distant ones, since
/// over neighbors alone work takes as many steps as there are ranks on its way, and small differences move nothing.
class Diffusion final : public Policy {
 public:
  explicit Diffusion(double rate) : rate_(rate) {}

  [[nodiscard]] Placement placement() const override { return Placement::kNeighbors; }
  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank self) const override {
    return Round(snapshot, self, rate_).moves();
  }

 private:
  double rate_;
};

}  // namespace

std::unique_ptr<Policy> make_diffusion(Parameters& parameters) {
  return std::make_unique<Diffusion>(parameters.number("rate", 1, 0.01, 1));
}

}  // namespace driftmesh::balancer
