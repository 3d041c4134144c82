#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "balancer/policy_list.hpp"
#include "cluster/cluster_spec.hpp"
#include "job/key.hpp"

namespace driftmesh::job {

/// Where the mesh of a request is made. `launched`: as one of the processes of mpirun or its like. Experiments name
/// their place (cluster.kind); other meshes are made on ranks if there are some, in subdomains if some are asked for,
/// and in one piece otherwise.
[[nodiscard]] Place place_of(const Request& request, Door door, bool launched);

/// Throws KeyError for values that are missing, out of range, do not go together, or mean nothing at `place`: a key
/// that would have to be ignored there is refused unless its value is the default. Files are not looked at; parameters
/// of the policy are, if `policies` can make it.
void check(const Request& request, Place place, const balancer::PolicyMaker& policies = nullptr);

/// Throws KeyError for values that `ranks` ranks, which exist, do not allow.
void check_ranks(const Request& request, Place place, std::int32_t ranks);

/// The parameters of the policy: of those that name one, as zoltan.method does, only the ones that name this. Throws
/// KeyError for a policy that does not exist.
[[nodiscard]] std::map<std::string, std::string> parameters_of_policy(const Request& request);

/// The share of its time that each of `ranks` real ranks works: 1, but where the request drags some.
[[nodiscard]] IdVector<Rank, double> shares_of_time(const Request& request, std::int32_t ranks);

/// The cluster to simulate.
[[nodiscard]] ClusterSpec cluster_of(const Request& request);

}  // namespace driftmesh::job
