#include "protocol/directory.hpp"

#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh::protocol {

Directory::Directory(Rank self, IdSpan<SubdomainId, const Rank> owners) : self_(self) {
  for (const Rank owner : owners) {
    records_.push_back({owner, 0});
    held_.push_back(owner == self);
  }
}

Directory::Route Directory::route(SubdomainId s, Epoch epoch) const {
  if (holds(s)) return Route::kHere;
  const Location record = where(s);
  return record.owner == self_ || record.epoch < epoch ? Route::kHold : Route::kForward;
}

Location Directory::depart(SubdomainId s, Rank destination) {
  if (!holds(s))
    throw Error("rank " + to_string(self_) + " cannot give away subdomain " + to_string(s) +
                ", which it does not hold");
  held_[s] = false;
  return records_[s] = {destination, where(s).epoch + 1};
}

bool Directory::arrive(SubdomainId s, Epoch epoch) {
  if (route(s, epoch) != Route::kHold || where(s).epoch > epoch) return false;
  held_[s] = true;
  records_[s] = {self_, epoch};
  return true;
}

}  // namespace driftmesh::protocol
