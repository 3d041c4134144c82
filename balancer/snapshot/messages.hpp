#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/load_snapshot.hpp"
#include "protocol/epoch.hpp"

/// The messages of load balancing. The wire format is in codec.cpp; to the protocol, all of them are advice.
namespace driftmesh::balancer {

/// An unfinished subdomain, as reported by its owner.
struct ReportedLoad {
  SubdomainId subdomain{};
  protocol::Epoch epoch = 0;  ///< with the sender as owner
  double remaining = 0;       ///< triangles still to be made, predicted
  std::uint64_t bytes = 0;    ///< estimated size of the packed form
  friend bool operator==(const ReportedLoad&, const ReportedLoad&) = default;
};

/// The sender's load and speed.
struct LoadReport {
  std::uint32_t round = 0;            ///< number of the sender's report, from 1; older ones are ignored
  std::uint32_t plan = 0;             ///< the round of the last Plan that the sender has acted on; 0: none
  double speed = 0;                   ///< triangles a second, a running average; 0: not known yet
  std::vector<ReportedLoad> loads;    ///< its unfinished subdomains and recent arrivals
  double doubt = 0;                   ///< standard deviation of the time that they take, over that time
  double unlisted = 0;                ///< triangles still to be made in other subdomains
  double free_memory = kAmpleMemory;  ///< as in RankLoad
  friend bool operator==(const LoadReport&, const LoadReport&) = default;
};

/// Moves that a planner advises the receiver to make.
struct Plan {
  std::uint32_t round = 0;
  std::vector<Move> moves;
  std::vector<Rank> ask;  ///< the destinations that may be short of memory: they are asked first (see Admission)
  friend bool operator==(const Plan&, const Plan&) = default;
};

/// The sender's total load.
struct LoadNews {
  std::uint32_t round = 0;            ///< number of the sender's news, from 1; older ones are ignored
  double remaining = 0;               ///< triangles still to be made, predicted
  double spare = 0;                   ///< the part in subdomains that it could give away
  double speed = 0;                   ///< triangles a second, a running average; 0: not known yet
  double doubt = 0;                   ///< standard deviation of remaining / speed, over that
  double free_memory = kAmpleMemory;  ///< as in RankLoad
  friend bool operator==(const LoadNews&, const LoadNews&) = default;
};

/// More seconds than any work takes.
inline constexpr double kNoHorizon = 1e300;

/// `thief` will soon be idle. It asks rank 0, which passes the request on to a rank with plenty of work. The thief gets
/// one answer, from the rank that has the request in the end.
struct WorkRequest {
  Rank thief{};
  std::uint32_t round = 0;  ///< number of the thief's request, from 1; 0: it has not asked, and waits for nothing
  double remaining = 0;     ///< the thief's remaining work
  double speed = 0;
  std::uint32_t rivals = 0;           ///< idle ranks that will compete for the giver's work
  double doubt = 0;                   ///< as in LoadNews
  double free_memory = kAmpleMemory;  ///< as in RankLoad
  double horizon = kNoHorizon;        ///< seconds: what the thief would begin later others can do earlier
  friend bool operator==(const WorkRequest&, const WorkRequest&) = default;
};

/// The answer to a WorkRequest: the subdomains on their way to the receiver, or none.
struct WorkAnswer {
  std::uint32_t round = 0;  ///< number of the request
  std::vector<Move> moves;
  friend bool operator==(const WorkAnswer&, const WorkAnswer&) = default;
};

/// A step toward moves to a rank that may be short of memory. Each question gets one answer; what was admitted comes,
/// or is returned.
struct Admission {
  enum class Stage : std::uint8_t {
    kAsk,     ///< the giver to the receiver: is there memory for these?
    kAnswer,  ///< the receiver to the giver: for these, and it is set aside for them
    kReturn,  ///< the giver to the receiver: these do not come after all
  };
  struct Guest {
    SubdomainId subdomain{};
    double triangles = 0;  ///< those made and those still to be made
    friend bool operator==(const Guest&, const Guest&) = default;
  };
  std::uint32_t round = 0;  ///< number of the giver's question, from 1
  Stage stage = Stage::kAsk;
  std::vector<Guest> guests;
  friend bool operator==(const Admission&, const Admission&) = default;
};

using Message = std::variant<LoadReport, Plan, LoadNews, WorkRequest, WorkAnswer, Admission>;

/// A message and its destination.
struct Outgoing {
  Rank destination{};
  Message message;
};

}  // namespace driftmesh::balancer
