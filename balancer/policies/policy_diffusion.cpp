#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "balancer/parameters.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {
namespace {

/// For each rank, the ranks adjacent to its listed subdomains, in ascending order.
IdVector<Rank, std::set<Rank>> touching_ranks(const LoadSnapshot& snapshot) {
  IdVector<Rank, std::set<Rank>> touching(snapshot.ranks.size());
  for (const SubdomainLoad& s : snapshot.subdomains)
    for (const Neighbor& n : (*snapshot.layout)[s.id].neighbors)
      if (const Rank other = owner_of(snapshot, n.subdomain); other != s.owner) {
        touching[s.owner].insert(other);
        touching[other].insert(s.owner);
      }
  return touching;
}

/// One rank's part of one round of diffusion.
class Round {
 public:
  Round(const LoadSnapshot& snapshot, Rank self, double rate)
      : snapshot_(snapshot),
        self_(self),
        rate_(rate),
        touching_(touching_ranks(snapshot)),
        speeds_(assumed_speeds(snapshot.ranks)),
        remaining_(snapshot.ranks[self].remaining) {}

  std::vector<Move> moves() {
    for (const Rank other : touching_[self_]) send_to(other);
    return moves_;
  }

 private:
  [[nodiscard]] double time(Rank r) const { return snapshot_.ranks[r].remaining / speeds_[r]; }

  // The flow in this round, in triangles: small enough that a rank does not become overloaded even if all its neighbors
  // send to it.
  [[nodiscard]] double flow(Rank from, Rank to) const {
    const auto degree = std::max(touching_[from].size(), touching_[to].size());
    return rate_ * std::max(0.0, time(from) - time(to)) * std::min(speeds_[from], speeds_[to]) /
           static_cast<double>(degree + 1);
  }

  void send_to(Rank other) {
    const double wanted = flow(self_, other);
    if (wanted <= 0) return;
    double sent = 0;
    double from_others = 0;
    for (const Rank r : touching_[other])
      if (r != self_) from_others += flow(r, other);
    for (const SubdomainLoad& s : easiest_first(other)) {
      // A flow smaller than any subdomain is rounded up if that still evens out, whatever the others send.
      const double then = time(other) + (from_others + sent + s.remaining) / speeds_[other];
      const bool rounded_up = sent == 0 && then < (remaining_ - s.remaining) / speeds_[self_];
      if (sent + s.remaining > wanted && !rounded_up) continue;
      sent += s.remaining;
      remaining_ -= s.remaining;
      gone_.insert(s.id);
      moves_.push_back({s.id, other});
    }
  }

  // All that is here but what is worked on now: what is light; of this what has most of its border with `other` and
  // least with what stays.
  [[nodiscard]] std::vector<SubdomainLoad> easiest_first(Rank other) const {
    std::map<SubdomainId, double> attachment;
    std::vector<SubdomainLoad> own;
    for (const SubdomainLoad& s : snapshot_.subdomains) {
      if (s.owner != self_ || s.turn == 0 || s.fixed || gone_.contains(s.id)) continue;
      own.push_back(s);
      for (const Neighbor& n : (*snapshot_.layout)[s.id].neighbors) {
        const Rank owner = owner_of(snapshot_, n.subdomain);
        attachment[s.id] += owner == other ? n.length : owner == self_ ? -n.length : 0;
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
  IdVector<Rank, std::set<Rank>> touching_;
  IdVector<Rank, double> speeds_;
  double remaining_;  // here, after moves_
  std::set<SubdomainId> gone_;
  std::vector<Move> moves_;
};

/// Work flows from a rank to the ranks that its subdomains touch and that would finish earlier, in proportion to the
/// difference (first-order diffusion, Cybenko 1989; for ranks of different speeds, Elsaesser, Monien and Preis 2002).
/// Imbalances of a few subdomains remain.
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
