#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "balancer/parameters.hpp"
#include "balancer/policy.hpp"

namespace driftmesh::balancer {
namespace {

std::size_t index(Rank rank) {
  return static_cast<std::size_t>(rank);
}

// Who owns a subdomain, as far as the snapshot tells; else who did at the start.
Rank owner_of(const LoadSnapshot& snapshot, SubdomainId id) {
  const SubdomainState* const known = find(snapshot, id);
  return known ? known->owner : (*snapshot.layout)[id].owner;
}

/// The ranks that each rank touches with a subdomain that is listed, in ascending order.
std::vector<std::set<Rank>> touching_ranks(const LoadSnapshot& snapshot) {
  std::vector<std::set<Rank>> touching(snapshot.ranks.size());
  for (const SubdomainState& s : snapshot.subdomains)
    for (const Neighbour& n : (*snapshot.layout)[s.id].neighbours)
      if (const Rank other = owner_of(snapshot, n.subdomain); other != s.owner) {
        touching[index(s.owner)].insert(other);
        touching[index(other)].insert(s.owner);
      }
  return touching;
}

/// Work flows from a rank to the ranks that its subdomains touch and that would finish earlier, in proportion to the
/// difference (first-order diffusion, Cybenko 1989, for ranks of different speeds as by Elsaesser, Monien and Preis
/// 2002). The shares are small enough that no rank can receive more than evens it out, whatever its other neighbours
/// do; so differences below some subdomains' worth remain.
class Diffusion final : public Policy {
 public:
  explicit Diffusion(double rate) : rate_(rate) {}

  [[nodiscard]] Placement placement() const override { return Placement::kNeighbours; }

  [[nodiscard]] std::vector<Move> plan(const LoadSnapshot& snapshot, Rank self) const override {
    const auto touching = touching_ranks(snapshot);
    const std::vector<double> speeds = assumed_speeds(snapshot.ranks);
    std::vector<Move> moves;
    std::set<SubdomainId> gone;
    for (const Rank other : touching[index(self)]) {
      const double ahead = snapshot.ranks[index(self)].remaining / speeds[index(self)] -
                           snapshot.ranks[index(other)].remaining / speeds[index(other)];
      const auto degree = std::max(touching[index(self)].size(), touching[index(other)].size());
      double flow =
          rate_ * ahead * std::min(speeds[index(self)], speeds[index(other)]) / static_cast<double>(degree + 1);
      for (const SubdomainState& s : most_attached_first(snapshot, self, other)) {
        if (s.remaining > flow || !gone.insert(s.id).second) continue;
        flow -= s.remaining;
        moves.push_back({s.id, other});
      }
    }
    return moves;
  }

 private:
  // What has most of its border with `other` and least with what stays.
  static std::vector<SubdomainState> most_attached_first(const LoadSnapshot& snapshot, Rank self, Rank other) {
    std::map<SubdomainId, double> attachment;
    std::vector<SubdomainState> own;
    for (const SubdomainState& s : snapshot.subdomains) {
      if (s.owner != self) continue;
      own.push_back(s);
      double& length = attachment[s.id];
      for (const Neighbour& n : (*snapshot.layout)[s.id].neighbours) {
        const Rank owner = owner_of(snapshot, n.subdomain);
        length += owner == other ? n.length : owner == self ? -n.length : 0;
      }
    }
    std::sort(own.begin(), own.end(), [&](const SubdomainState& a, const SubdomainState& b) {
      return std::tuple(-attachment[a.id], a.bytes, a.id) < std::tuple(-attachment[b.id], b.bytes, b.id);
    });
    return own;
  }

  double rate_;
};

}  // namespace

std::unique_ptr<Policy> make_diffusion(Parameters& parameters) {
  return std::make_unique<Diffusion>(parameters.number("rate", 1, 0.01, 1));
}

}  // namespace driftmesh::balancer
