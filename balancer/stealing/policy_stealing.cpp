#include "balancer/stealing/policy_stealing.hpp"

#include <algorithm>

#include "balancer/snapshot/effort.hpp"

namespace driftmesh::balancer {
namespace {

/// A rank that is about to work on its last subdomain asks for more, or `low_water` seconds before that. It gets some
/// from the rank that would finish last, which gives work as long as the thief would finish it earlier than the giver.
/// (Work stealing as in PREMA's load balancing library, Barker et al. 2004, weighted by speed.)
class Stealing final : public Policy {
 public:
  explicit Stealing(double low_water) : low_water_(low_water) {}

  [[nodiscard]] Placement placement() const override { return Placement::kRequests; }

  [[nodiscard]] bool runs_low(double seconds) const override { return seconds <= low_water_; }

  [[nodiscard]] std::optional<Rank> victim(const LoadSnapshot& snapshot, Rank thief,
                                           const IdVector<Rank, bool>& able) const override {
    note_effort("search", static_cast<double>(snapshot.ranks.size()));
    const double mean = mean_speed(snapshot.ranks);
    const auto speed = [&](const RankLoad& rank) { return is_speed(rank.speed) ? rank.speed : mean; };
    double latest = snapshot.ranks[thief].remaining / speed(snapshot.ranks[thief]);
    std::optional<Rank> found;
    for (const Rank r : ids_of(snapshot.ranks)) {
      const RankLoad& rank = snapshot.ranks[r];
      if (rank.remaining <= latest * speed(rank) || !able[r] || r == thief) continue;
      found = r;
      latest = rank.remaining / speed(rank);
    }
    return found;
  }

  [[nodiscard]] std::vector<Move> give(const LoadSnapshot& snapshot, Rank self, Rank to) const override {
    const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
    double mine = snapshot.ranks[self].remaining;
    double theirs = snapshot.ranks[to].remaining;
    std::vector<Move> moves;
    for (const SubdomainLoad& s : easiest_first(snapshot, self)) {
      if ((theirs + s.remaining) / speeds[to] >= mine / speeds[self]) continue;
      mine -= s.remaining;
      theirs += s.remaining;
      moves.push_back({s.id, to});
    }
    return moves;
  }

 private:
  static std::vector<SubdomainLoad> easiest_first(const LoadSnapshot& snapshot, Rank owner) {
    std::vector<SubdomainLoad> own;
    for (const SubdomainLoad& s : snapshot.subdomains)
      if (s.owner == owner) own.push_back(s);
    std::sort(own.begin(), own.end(), leaves_before);
    return own;
  }

  double low_water_;
};

}  // namespace

std::unique_ptr<Policy> make_stealing(Parameters& parameters) {
  return std::make_unique<Stealing>(parameters.number("low-water", 0, 0, 1e6));
}

PolicyMaker stealing_maker() {
  return [](const std::string& name, const Parameters::Values& values) {
    Parameters parameters(name, values);
    return make_stealing(parameters);
  };
}

}  // namespace driftmesh::balancer
