#include <algorithm>
#include <memory>
#include <tuple>

#include "balancer/parameters.hpp"
#include "balancer/policy.hpp"

namespace driftmesh::balancer {
namespace {

std::size_t index(Rank rank) {
  return static_cast<std::size_t>(rank);
}

/// A rank whose work will be done within `low_water` seconds asks the rank that it believes to finish last, which gives
/// of what it has as long as the asking rank would finish that earlier than the giver would. (Work stealing as in
/// PREMA's load balancing library, Barker et al. 2004, weighed with speeds.)
class Stealing final : public Policy {
 public:
  explicit Stealing(double low_water) : low_water_(low_water) {}

  [[nodiscard]] Placement placement() const override { return Placement::kRequests; }

  [[nodiscard]] std::optional<Rank> ask(const LoadSnapshot& snapshot, Rank self,
                                        const std::vector<bool>& willing) const override {
    const std::vector<double> finish = finishing_times(snapshot);
    if (finish[index(self)] > low_water_) return std::nullopt;
    const double least = finish[index(self)] + low_water_;
    double latest = least;
    for (std::size_t r = 0; r < finish.size(); ++r)
      if (willing[r]) latest = std::max(latest, finish[r]);
    // Ranks that look much the same are not all asked by everybody at once: each looks from its own number on.
    const auto ranks = static_cast<Rank>(finish.size());
    for (Rank step = 1; step < ranks; ++step) {
      const Rank r = (self + step) % ranks;
      if (willing[index(r)] && finish[index(r)] > least && finish[index(r)] >= kMuchTheSame * latest) return r;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<Move> give(const LoadSnapshot& snapshot, Rank self, Rank to) const override {
    const std::vector<double> speeds = assumed_speeds(snapshot.ranks);
    double mine = snapshot.ranks[index(self)].remaining;
    double theirs = snapshot.ranks[index(to)].remaining;
    std::vector<Move> moves;
    for (const SubdomainState& s : cheapest_first(snapshot, self)) {
      if ((theirs + s.remaining) / speeds[index(to)] >= mine / speeds[index(self)]) continue;
      mine -= s.remaining;
      theirs += s.remaining;
      moves.push_back({s.id, to});
    }
    return moves;
  }

 private:
  static constexpr double kMuchTheSame = 0.9;

  static std::vector<double> finishing_times(const LoadSnapshot& snapshot) {
    std::vector<double> times = assumed_speeds(snapshot.ranks);
    for (std::size_t r = 0; r < times.size(); ++r) times[r] = snapshot.ranks[r].remaining / times[r];
    return times;
  }

  static std::vector<SubdomainState> cheapest_first(const LoadSnapshot& snapshot, Rank owner) {
    std::vector<SubdomainState> own;
    for (const SubdomainState& s : snapshot.subdomains)
      if (s.owner == owner) own.push_back(s);
    std::sort(own.begin(), own.end(), [](const SubdomainState& a, const SubdomainState& b) {
      return std::tuple(a.bytes, -a.remaining, a.id) < std::tuple(b.bytes, -b.remaining, b.id);
    });
    return own;
  }

  double low_water_;
};

}  // namespace

std::unique_ptr<Policy> make_stealing(Parameters& parameters) {
  return std::make_unique<Stealing>(parameters.number("low-water", 0.1, 1e-6, 1e6));
}

}  // namespace driftmesh::balancer
