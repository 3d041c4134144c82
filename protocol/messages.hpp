#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "dyadic/split_point.hpp"
#include "protocol/ids.hpp"

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

struct SubdomainLoad {
  SubdomainId subdomain{};
  Epoch epoch = 0;          ///< with the sender as owner
  double remaining = 0;     ///< triangles still to be made, predicted
  std::uint64_t bytes = 0;  ///< of the packed form, estimated
  friend bool operator==(const SubdomainLoad&, const SubdomainLoad&) = default;
};

/// What the sender has to do, and how fast it is.
struct LoadReport {
  std::uint32_t round = 0;           ///< of the sender's reports, from 1: an older one says nothing new
  std::uint32_t plan = 0;            ///< the round of the last Plan that the sender has acted on; 0: none
  double speed = 0;                  ///< triangles a second, a running average; 0: not known yet
  std::vector<SubdomainLoad> loads;  ///< of its subdomains that are not finished, and of those that came lately
  friend bool operator==(const LoadReport&, const LoadReport&) = default;
};

struct PlannedMove {
  SubdomainId subdomain{};
  Rank destination{};
  friend bool operator==(const PlannedMove&, const PlannedMove&) = default;
};

/// Moves that a planner advises the receiver to make.
struct Plan {
  std::uint32_t round = 0;
  std::vector<PlannedMove> moves;
  friend bool operator==(const Plan&, const Plan&) = default;
};

/// What the sender has to do altogether.
struct LoadNews {
  std::uint32_t round = 0;  ///< of the sender's news, from 1: older ones say nothing new
  double remaining = 0;     ///< triangles still to be made, predicted
  double spare = 0;         ///< of these, in subdomains that it could give away
  double speed = 0;         ///< triangles a second, a running average; 0: not known yet
  friend bool operator==(const LoadNews&, const LoadNews&) = default;
};

/// `thief` will soon have nothing to do. It asks rank 0, which passes the request on to a rank that has much. The thief
/// gets one answer, from whoever has the request in the end.
struct WorkRequest {
  Rank thief{};
  std::uint32_t round = 0;  ///< of the thief's requests, from 1; 0: the thief has not asked, and waits for nothing
  double remaining = 0;     ///< what the thief has still to do
  double speed = 0;
  std::uint32_t rivals = 0;  ///< idle ranks that will want their share of what the giver has
  friend bool operator==(const WorkRequest&, const WorkRequest&) = default;
};

/// The answer to a WorkRequest: what is on its way to the receiver, or nothing.
struct WorkAnswer {
  std::uint32_t round = 0;  ///< of the request
  std::vector<PlannedMove> moves;
  friend bool operator==(const WorkAnswer&, const WorkAnswer&) = default;
};

/// A step on the way to a plan that all ranks make at the same time.
struct JointRound {
  enum class Stage : std::uint8_t {
    kCall,   ///< rank 0 to all: come together
    kReady,  ///< each to rank 0: the call was heard
    kStart,  ///< rank 0 to all: everybody has heard it, plan now
  };
  std::uint32_t round = 0;  ///< from 1
  Stage stage = Stage::kCall;
  friend bool operator==(const JointRound&, const JointRound&) = default;
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

using Message = std::variant<SplitBatch, HandOff, LocationUpdate, LoadReport, Plan, Token, Terminate, Finish,
                             WorkRequest, WorkAnswer, LoadNews, JointRound>;

enum class Traffic { kWork, kControl, kDetection };
[[nodiscard]] Traffic traffic_of(const Message& message);

/// A message and the rank that it goes to.
struct Outgoing {
  Rank destination{};
  Message message;
};

}  // namespace driftmesh::protocol
