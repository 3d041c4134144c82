#pragma once

#include <map>
#include <string>
#include <vector>

#include "balancer/snapshot/effort.hpp"
#include "driftmesh/load_snapshot.hpp"

/// The only part of the project that uses Zoltan.
namespace driftmesh::balancer {

/// Zoltan's parameters by their names, LB_METHOD and the like.
using ZoltanParameters = std::map<std::string, std::string>;

/// The names of the parameters of Zoltan's partitioners, except those that zoltan_partition sets itself.
[[nodiscard]] const std::vector<std::string>& zoltan_parameter_names();

/// Whether Zoltan accepts this parameter value. It checks some values only when it partitions.
[[nodiscard]] bool zoltan_accepts(const std::string& name, const std::string& value);

/// Whether this build of Zoltan partitions at all with these parameters: a graph partitioner such as ParMETIS may be
/// missing. Zoltan says why not on standard error.
[[nodiscard]] bool zoltan_partitions_with(const ZoltanParameters& parameters);

/// The effort of zoltan_partition, which notes it.
[[nodiscard]] Efforts effort_of_parts(const LoadSnapshot& snapshot, const ZoltanParameters& parameters);

/// The part, 0 .. ranks - 1, of each listed subdomain: the remaining work of the parts is in proportion to the speeds
/// of the ranks. Runs within this process; the same arguments give the same parts. Parts may be empty. Initializes MPI
/// if necessary. Throws Error if Zoltan fails.
[[nodiscard]] std::vector<Part> zoltan_partition(const LoadSnapshot& snapshot, const ZoltanParameters& parameters);

/// The same collectively by all processes of an MPI communicator, given by its Fortran handle: each lists its own
/// subdomains, none is listed twice, and the states of ranks are equal everywhere. Returns the parts of `own`.
[[nodiscard]] std::vector<Part> zoltan_partition(const LoadSnapshot& own, const ZoltanParameters& parameters,
                                                 int communicator);

}  // namespace driftmesh::balancer
