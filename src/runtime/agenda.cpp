#include "runtime/agenda.hpp"

#include "driftmesh/error.hpp"

namespace driftmesh {

void Agenda::put(const Item& item) {
  remove(item.id);
  if (!place_.has(item.id)) place_.resize(to_index(item.id) + 1);
  place_[item.id] = place_of(item);
  queue_.insert(*place_[item.id]);
}

void Agenda::remove(SubdomainId id) {
  if (!place_.has(id) || !place_[id]) return;
  queue_.erase(*place_[id]);
  place_[id].reset();
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
