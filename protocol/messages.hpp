#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"
#include "dyadic/split_point.hpp"
#include "protocol/epoch.hpp"

/// What ranks say to each other. The layout on the wire is in codec.cpp; the rules are in docs/protocol.md.
namespace driftmesh::protocol {

// ---- Work: counted by the termination detector -----------------------------------------------------------------

/// SPLITs for one subdomain, from one rank.
struct SplitGroup {
  SubdomainId to{};
  Epoch epoch = 0;         ///< of `to`, as the rank that sent or forwarded the group last believed
  Rank origin{};           ///< the rank that made the points; it is told when the group had to be forwarded
  std::uint32_t hops = 0;  ///< how often it was forwarded: not above `epoch`, which rises with each
  std::vector<SplitPoint<GlobalRootId>> points;
  friend bool operator==(const SplitGroup&, const SplitGroup&) = default;
};

/// What an aggregator held for one rank.
struct SplitBatch {
  std::vector<SplitGroup> groups;
  friend bool operator==(const SplitBatch&, const SplitBatch&) = default;
};

/// Packed forms that are estimated longer stay where they are: a message must not reach 2 GiB, and the estimate may be
/// a quarter too low.
inline constexpr std::uint64_t kMostPackedBytes = 1'600'000'000;

/// A subdomain moves to the rank that this is sent to.
struct HandOff {
  SubdomainId subdomain{};
  Epoch epoch = 0;  ///< with the receiver as owner
  Bytes packed;     ///< the packed form; opaque to the protocol
  friend bool operator==(const HandOff&, const HandOff&) = default;
};

// ---- Control: advice, not counted, refused once the work is over -----------------------------------------------

/// Where a subdomain is, or was a while ago.
struct LocationUpdate {
  SubdomainId subdomain{};
  Rank owner{};
  Epoch epoch = 0;
  friend bool operator==(const LocationUpdate&, const LocationUpdate&) = default;
};

/// What whoever plans for the ranks says to another rank. The protocol carries it without knowing what it says.
struct Advice {
  std::uint8_t topic = 0;  ///< what kind of advice it is; small, because it travels in the byte of the message's type
  Bytes content;
  friend bool operator==(const Advice&, const Advice&) = default;
};

/// The sender gives the whole run up: nobody need do any more work.
struct Abandon {
  friend bool operator==(const Abandon&, const Abandon&) = default;
};

// ---- Detection: how the end is found; each of these travels along the ring of ranks ------------------------------

/// Safra's token (EWD998).
struct Token {
  std::uint64_t round = 0;  ///< the probes of rank 0, from 1
  std::int64_t count = 0;   ///< SPLITs and hand-offs sent less handled, over the ranks visited
  bool black = false;       ///< whether a visited rank has handled any since the last visit
  friend bool operator==(const Token&, const Token&) = default;
};

/// The work is over; what is left is control traffic under way.
struct Terminate {
  std::uint64_t pass = 0;    ///< around the ring, from 1
  std::int64_t work = 0;     ///< sent less handled over the ranks visited: an audit, 0 at the end of a pass
  std::int64_t control = 0;  ///< control messages sent less received over the ranks visited
  friend bool operator==(const Terminate&, const Terminate&) = default;
};

/// Nothing is under way any more but this.
struct Finish {
  friend bool operator==(const Finish&, const Finish&) = default;
};

using Message = std::variant<SplitBatch, HandOff, LocationUpdate, Token, Terminate, Finish, Abandon, Advice>;

enum class Traffic { kWork, kControl, kDetection };
[[nodiscard]] Traffic traffic_of(const Message& message);

/// A message and the rank that it goes to.
struct Outgoing {
  Rank destination{};
  Message message;
};

}  // namespace driftmesh::protocol
