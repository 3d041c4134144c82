#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "balancer/messages.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// What a rank that plans knows of others from their reports, and of what it has planned itself.
class Knowledge {
 public:
  /// `patience`: seconds after which a planned move of which nothing was heard is forgotten.
  Knowledge(std::shared_ptr<const Layout> layout, double patience);

  /// Takes in a report that came (or was made here) at `now`. An older one than the last of that rank, and what it says
  /// of subdomains that have moved since, is ignored.
  void hear(Rank rank, const LoadReport& report, double now);

  /// These moves were advised, under this number. Until they are seen to be made or not, they count as made.
  void expect(std::span<const Move> moves, const LoadSnapshot& planned_on, std::uint32_t plan, double now);

  /// Whether a planned move of it is not settled: it may be anywhere.
  [[nodiscard]] bool in_motion(SubdomainId id) const { return planned_.contains(id); }
  /// Whether all ranks have said something.
  [[nodiscard]] bool complete() const { return heard_ == ranks_.size(); }
  /// Who owns a subdomain, as far as was heard.
  [[nodiscard]] Rank owner_of(SubdomainId id) const;

  /// The load at `now`: reports, less what a rank must have done since at its speed, in the order that it told. Ranks
  /// that have not said anything have what the layout predicts; their subdomains are listed if `with_silent` says so.
  [[nodiscard]] LoadSnapshot snapshot(double now, bool with_silent) const;

 private:
  struct Heard {
    bool any = false;
    std::uint32_t round = 0;
    double at = 0;
    double speed = 0;
    std::vector<ReportedLoad> loads;  // in the order of work
    double predicted = 0;             // of the layout, for one that has said nothing
  };
  struct Claim {
    Rank owner{};
    protocol::Epoch epoch = 0;
  };
  struct Planned {
    Rank from{}, to{};
    std::uint32_t plan = 0;
    double at = 0;
    SubdomainLoad load;
  };
  void settle_planned(Rank rank, const LoadReport& report, double now);
  void list(LoadSnapshot& snapshot, Rank rank, const std::vector<SubdomainLoad>& arriving, double now) const;

  std::shared_ptr<const Layout> layout_;
  double patience_;
  IdVector<Rank, Heard> ranks_;
  std::size_t heard_ = 0;
  std::unordered_map<SubdomainId, Claim> claims_;
  std::map<SubdomainId, Planned> planned_;
};

}  // namespace driftmesh::balancer
