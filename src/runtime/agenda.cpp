#include "runtime/agenda.hpp"

#include "driftmesh/error.hpp"

namespace driftmesh {

void Agenda::put(const Item& item) {
  remove(item.id);
  const Place place = place_of(item);
  place_.emplace(item.id, place);
  queue_.insert(place);
}

void Agenda::remove(SubdomainId id) {
  const auto known = place_.find(id);
  if (known == place_.end()) return;
  queue_.erase(known->second);
  place_.erase(known);
}

std::optional<SubdomainId> Agenda::first() const {
  if (queue_.empty()) return std::nullopt;
  return queue_.begin()->id;
}

std::vector<SubdomainId> Agenda::in_order() const {
  std::vector<SubdomainId> ids;
  for (const Place& place : queue_) ids.push_back(place.id);
  return ids;
}

Agenda::Place Agenda::place_of(const Item& item) const {
  if (item.begun) return {0, 0, item.id};
  const double urgency = order_ == WorkOrder::kLargest   ? item.remaining
                         : order_ == WorkOrder::kBacklog ? static_cast<double>(item.backlog)
                                                         : 0;
  if (item.refined) return {2, static_cast<double>(item.backlog), item.id};
  return {1, urgency, item.id};
}

}  // namespace driftmesh
