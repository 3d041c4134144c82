#pragma once

#include <vector>

#include "driftmesh/ids.hpp"
#include "protocol/epoch.hpp"

namespace driftmesh::protocol {

/// The owner of a subdomain in one of its epochs. An epoch has one owner, chosen by the owner of the previous epoch.
struct Location {
  Rank owner{};
  Epoch epoch = 0;
  friend bool operator==(const Location&, const Location&) = default;
};

/// One rank's knowledge of where every subdomain is. It only moves forward: a record of a higher epoch replaces one of
/// a lower, never the reverse.
///
/// What to do with a message for a subdomain that says epoch m, and so was sent to the owner of epoch m:
///   here      this rank holds the subdomain;
///   hold      it does not, but owns it in an epoch >= m by its record, or its record is older than m: the subdomain
///             is on its way here, because a rank that has let go of epoch m has a record above m;
///   forward   otherwise, to the owner in the record, with the record's epoch, which is above m: a record (q, m) with
///             another owner q would give epoch m two owners.
/// Epochs rise with every hop, so a message never circles, and is forwarded at most (epoch in which it is handled -
/// epoch it was first sent with) times.
class Directory {
 public:
  enum class Route { kHere, kHold, kForward };

  /// `owners[s]` is the owner of subdomain s in epoch 0.
  Directory(Rank self, IdSpan<SubdomainId, const Rank> owners);

  [[nodiscard]] std::size_t subdomains() const { return records_.size(); }
  [[nodiscard]] Location where(SubdomainId s) const { return records_.at(s); }
  [[nodiscard]] bool holds(SubdomainId s) const { return held_.at(s); }
  [[nodiscard]] Route route(SubdomainId s, Epoch epoch) const;

  /// Sets a record without checking whether it is newer; RankProtocol checks that.
  void set(SubdomainId s, const Location& location) { records_.at(s) = location; }
  /// Gives up a subdomain held here; returns its next location. Throws Error if it is not held here.
  Location depart(SubdomainId s, Rank destination);
  /// Takes over a subdomain that was handed to this rank. Returns false and changes nothing if that is impossible: the
  /// subdomain is here, or this rank has already given up this epoch.
  [[nodiscard]] bool arrive(SubdomainId s, Epoch epoch);

 private:
  Rank self_;
  IdVector<SubdomainId, Location> records_;
  IdVector<SubdomainId, bool> held_;
};

}  // namespace driftmesh::protocol
