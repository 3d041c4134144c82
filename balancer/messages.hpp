#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/load_snapshot.hpp"
#include "protocol/epoch.hpp"

/// What ranks say to each other to balance their load. The layout on the wire is in codec.cpp; to the protocol all of
/// it is advice.
namespace driftmesh::balancer {

/// A subdomain that is not finished, as its owner reports it.
struct ReportedLoad {
  SubdomainId subdomain{};
  protocol::Epoch epoch = 0;  ///< with the sender as owner
  double remaining = 0;       ///< triangles still to be made, predicted
  std::uint64_t bytes = 0;    ///< of the packed form, estimated
  friend bool operator==(const ReportedLoad&, const ReportedLoad&) = default;
};

/// What the sender has to do, and how fast it is.
struct LoadReport {
  std::uint32_t round = 0;          ///< of the sender's reports, from 1: an older one says nothing new
  std::uint32_t plan = 0;           ///< the round of the last Plan that the sender has acted on; 0: none
  double speed = 0;                 ///< triangles a second, a running average; 0: not known yet
  std::vector<ReportedLoad> loads;  ///< of its subdomains that are not finished, and of those that came lately
  friend bool operator==(const LoadReport&, const LoadReport&) = default;
};

/// Moves that a planner advises the receiver to make.
struct Plan {
  std::uint32_t round = 0;
  std::vector<Move> moves;
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
  std::vector<Move> moves;
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

using Message = std::variant<LoadReport, Plan, LoadNews, WorkRequest, WorkAnswer, JointRound>;

/// A message and the rank that it goes to.
struct Outgoing {
  Rank destination{};
  Message message;
};

}  // namespace driftmesh::balancer
