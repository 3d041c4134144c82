#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"
#include "dyadic/split_point.hpp"
#include "protocol/epoch.hpp"

/// The messages between ranks. The wire format is in codec.cpp, the rules in docs/protocol.md.
namespace driftmesh::protocol {

// ---- Work: counted by the termination detector -----------------------------------------------------------------

/// SPLITs for one subdomain, from one rank.
struct SplitGroup {
  SubdomainId to{};
  Epoch epoch = 0;         ///< epoch of `to`, as known to the rank that sent or last forwarded the group
  Rank origin{};           ///< the rank that made the points; it is told when the group had to be forwarded
  std::uint32_t hops = 0;  ///< how often it was forwarded: at most `epoch`, which rises with every hop
  std::vector<SplitPoint<GlobalRootId>> points;
  friend bool operator==(const SplitGroup&, const SplitGroup&) = default;
};

/// The SPLITs that an aggregator held for one rank.
struct SplitBatch {
  std::vector<SplitGroup> groups;
  friend bool operator==(const SplitBatch&, const SplitBatch&) = default;
};

/// Moves a subdomain to the receiver (packed_size.hpp: which ones).
struct HandOff {
  SubdomainId subdomain{};
  Epoch epoch = 0;  ///< with the receiver as owner
  Bytes packed;     ///< the packed form; opaque to the protocol
  friend bool operator==(const HandOff&, const HandOff&) = default;
};

// ---- Control: advice, not counted, rejected once the work is over -----------------------------------------------

/// The current or a former location of a subdomain.
struct LocationUpdate {
  SubdomainId subdomain{};
  Rank owner{};
  Epoch epoch = 0;
  friend bool operator==(const LocationUpdate&, const LocationUpdate&) = default;
};

/// A message of the load balancer. The protocol carries it without interpreting it.
struct Advice {
  std::uint8_t topic = 0;  ///< kind of advice; small, because it is encoded in the type byte of the message
  Bytes content;
  friend bool operator==(const Advice&, const Advice&) = default;
};

/// The sender gives up the whole run: no more work is needed.
struct Abandon {
  friend bool operator==(const Abandon&, const Abandon&) = default;
};

// ---- Detection of termination: questions of rank 0 down the tree of ranks, and the sums of answers up -----------

/// Whether the work is over, after Safra (EWD998). Down the tree it is the question, with count 0 and white.
struct Token {
  static constexpr const char* kName = "token";
  std::uint64_t round = 0;  ///< the probes of rank 0, from 1
  std::int64_t count = 0;   ///< SPLITs and hand-offs sent less handled, over the ranks that answered
  bool black = false;       ///< whether one of them has handled any since its last answer
  Token& operator+=(const Token& other) {
    count += other.count;
    black = black || other.black;
    return *this;
  }
  friend bool operator==(const Token&, const Token&) = default;
};

/// The work is over; only control traffic may still be in transit. Down the tree both sums are 0.
struct Terminate {
  static constexpr const char* kName = "termination pass";
  std::uint64_t round = 0;   ///< the passes of rank 0, from 1
  std::int64_t work = 0;     ///< sent less handled over the ranks that answered: an audit, 0 at the end of a pass
  std::int64_t control = 0;  ///< control messages sent less received over the ranks that answered
  Terminate& operator+=(const Terminate& other) {
    work += other.work;
    control += other.control;
    return *this;
  }
  friend bool operator==(const Terminate&, const Terminate&) = default;
};

/// Nothing else is in transit any more.
struct Finish {
  friend bool operator==(const Finish&, const Finish&) = default;
};

using Message = std::variant<SplitBatch, HandOff, LocationUpdate, Token, Terminate, Finish, Abandon, Advice>;

enum class Traffic { kWork, kControl, kDetection };
[[nodiscard]] Traffic traffic_of(const Message& message);

/// A message and its destination.
struct Outgoing {
  Rank destination{};
  Message message;
};

}  // namespace driftmesh::protocol
