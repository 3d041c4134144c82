#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "balancer/policy_interface/policy_list.hpp"
#include "cluster/cluster_spec.hpp"
#include "job/key.hpp"

namespace driftmesh::job {

/// Where the mesh of a request is made. `launched`: whether this is one of the processes started by mpirun or the like.
/// Experiments name their place (cluster.kind); other meshes are made on ranks if launched, in subdomains if the
/// request has several, and in one piece otherwise, unless it is large (see Cut).
[[nodiscard]] PlaceKind place_of(const Request& request, EntryPoint entry_point, bool launched);

/// Throws KeyError for values that are missing, out of range, contradictory, or do not apply at `place`: a key that
/// would be ignored there is rejected unless it has its default value. Files are not examined; parameters of the policy
/// are, if `policies` is given.
void check(const Request& request, PlaceKind place, const balancer::PolicyMaker& policies = nullptr);

/// Throws KeyError if one of the keys in `given`, which somebody has set, does nothing with its value, though that may
/// be the default.
void check_given(const Request& request, const std::set<std::string>& given);

/// Whether settings suit a process that knows of no other. Throws KeyError.
void check_alone(const Request& request);

/// Throws KeyError for values that do not fit the actual number of ranks.
void check_ranks(const Request& request, PlaceKind place, std::int32_t ranks);

/// The parameters for the request's policy: of those that name a policy, as zoltan.method does, only those that name
/// this one. Throws KeyError for an unknown policy.
[[nodiscard]] std::map<std::string, std::string> parameters_of_policy(const Request& request);

/// The fraction of its time that each of `ranks` real ranks works: 1 unless the request slows it down (cluster.drag).
[[nodiscard]] IdVector<Rank, double> shares_of_time(const Request& request, std::int32_t ranks);

/// The cluster to simulate.
[[nodiscard]] ClusterSpec cluster_of(const Request& request);

}  // namespace driftmesh::job
