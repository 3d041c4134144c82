#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/options.hpp"

namespace driftmesh {

/// The subdomains of a rank that have something to do, in the order of a policy. With any policy, started subdomains
/// are finished first, since their meshes are in the cache; and subdomains that have met their bounds once, and have
/// received points since, come last, since more points may be in transit.
class Agenda {
 public:
  explicit Agenda(WorkOrder order) : order_(order) {}

  struct Item {
    SubdomainId id{};
    bool begun = false;       ///< has worked, and has not met its bounds yet
    bool refined = false;     ///< has met its bounds before
    double remaining = 0;     ///< triangles to be made
    std::size_t backlog = 0;  ///< points to insert
  };
  /// Adds a subdomain, or updates its position.
  void put(const Item& item);
  void remove(SubdomainId id);
  void clear() {
    queue_.clear();
    place_.clear();
  }
  /// The subdomain to work on next.
  [[nodiscard]] std::optional<SubdomainId> first() const;
  /// All of them, in that order.
  [[nodiscard]] std::vector<SubdomainId> in_order() const;
  [[nodiscard]] bool empty() const { return queue_.empty(); }
  [[nodiscard]] std::size_t size() const { return queue_.size(); }

 private:
  struct Place {
    int tier;
    double urgency;  // more is earlier
    SubdomainId id;
    friend bool operator<(const Place& a, const Place& b) {
      if (a.tier != b.tier) return a.tier < b.tier;
      if (a.urgency != b.urgency) return a.urgency > b.urgency;
      return a.id < b.id;
    }
  };
  [[nodiscard]] Place place_of(const Item& item) const;

  WorkOrder order_;
  std::set<Place> queue_;
  std::map<SubdomainId, Place> place_;  // subdomains in the queue
};

}  // namespace driftmesh
