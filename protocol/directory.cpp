#include "protocol/directory.hpp"

#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh::protocol {

Directory::Record Directory::record_of(SubdomainId s) const {
  const auto known = records_.find(s);
  if (known != records_.end()) return known->second;
  return {{owners_[s], 0}, owners_[s] == self_};
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
  const Location next{destination, where(s).epoch + 1};
  records_[s] = {next, false};
  return next;
}

bool Directory::arrive(SubdomainId s, Epoch epoch) {
  if (route(s, epoch) != Route::kHold || where(s).epoch > epoch) return false;
  records_[s] = {{self_, epoch}, true};
  return true;
}

}  // namespace driftmesh::protocol
