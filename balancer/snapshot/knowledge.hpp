#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "balancer/snapshot/messages.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// A planner's knowledge of other ranks from their reports, and of its own plans.
class Knowledge {
 public:
  /// `patience`: seconds after which an unconfirmed planned move is forgotten.
  Knowledge(std::shared_ptr<const Layout> layout, double patience);

  /// Handles a report that arrived (or was made here) at `now`. Ignored if older than the last one of that rank, as is
  /// what it says of subdomains that have moved since.
  void hear(Rank rank, const LoadReport& report, double now);

  /// Records advised moves under this plan number. They count as made until reports confirm or refute them.
  void expect(std::span<const Move> moves, const LoadSnapshot& planned_on, std::uint32_t plan, double now);

  /// The moves of this plan were advised so many seconds after the moment given to expect(): it took that long to make.
  void put_off(std::uint32_t plan, double seconds);

  /// Whether a planned move of this subdomain is unsettled, so that it may be anywhere.
  [[nodiscard]] bool in_motion(SubdomainId id) const { return planned_.contains(id); }
  /// Memory that the ranks need for what planned moves bring them, in triangles.
  [[nodiscard]] std::map<Rank, double> on_its_way() const;
  /// Whether all ranks have reported.
  [[nodiscard]] bool complete() const { return heard_ == ranks_.size(); }
  /// The owner of a subdomain, as far as known.
  [[nodiscard]] Rank owner_of(SubdomainId id) const;

  /// The load at `now`: reports minus what a rank must have done since at its speed, in its reported order. Ranks
  /// without a report have the load that the layout predicts; their subdomains are listed if `with_silent`. They may
  /// not be there yet: nothing is to go there, as if they had no memory.
  [[nodiscard]] LoadSnapshot snapshot(double now, bool with_silent) const;

 private:
  struct Heard {
    bool any = false;
    std::uint32_t round = 0;
    double at = 0;
    double speed = 0;
    double doubt = 0;
    std::vector<ReportedLoad> loads;  // in the order of work
    double unlisted = 0;              // other work; without a report, all that the layout predicts
    double free_memory = kAmpleMemory;
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
  /// Returns what is left of its unlisted work.
  double list(LoadSnapshot& snapshot, Rank rank, const std::vector<SubdomainLoad>& arriving, double now) const;
  void list_silent(LoadSnapshot& snapshot) const;

  std::shared_ptr<const Layout> layout_;
  double patience_;
  IdVector<Rank, Heard> ranks_;
  std::size_t heard_ = 0;
  std::unordered_map<SubdomainId, Claim> claims_;
  std::map<SubdomainId, Planned> planned_;
};

}  // namespace driftmesh::balancer
