#pragma once

#include <cstddef>
#include <map>

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
/// a lower, never the reverse. A rank has records of the subdomains that have moved as far as it knows, which are few;
/// the others are where they were at the start, which all ranks of one process can share.
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

  /// `owners[s]` is the owner of subdomain s in epoch 0. They must outlive the directory.
  Directory(Rank self, IdSpan<SubdomainId, const Rank> owners) : self_(self), owners_(owners) {}

  [[nodiscard]] std::size_t subdomains() const { return owners_.size(); }
  [[nodiscard]] Location where(SubdomainId s) const { return record_of(s).location; }
  [[nodiscard]] bool holds(SubdomainId s) const { return record_of(s).held; }
  [[nodiscard]] Route route(SubdomainId s, Epoch epoch) const;

  /// Sets a record without checking whether it is newer; RankProtocol checks that.
  void set(SubdomainId s, const Location& location) { records_[s] = {location, holds(s)}; }
  /// Gives up a subdomain held here; returns its next location. Throws Error if it is not held here.
  Location depart(SubdomainId s, Rank destination);
  /// Takes over a subdomain that was handed to this rank. Returns false and changes nothing if that is impossible: the
  /// subdomain is here, or this rank has already given up this epoch.
  [[nodiscard]] bool arrive(SubdomainId s, Epoch epoch);

 private:
  struct Record {
    Location location;
    bool held = false;
  };
  [[nodiscard]] Record record_of(SubdomainId s) const;

  Rank self_;
  IdSpan<SubdomainId, const Rank> owners_;
  std::map<SubdomainId, Record> records_;
};

}  // namespace driftmesh::protocol
