#pragma once

#include <string>
#include <vector>

#include "driftmesh/load_snapshot.hpp"
#include "driftmesh/policy.hpp"

/// The only part of the project that knows Zoltan.
namespace driftmesh::balancer {

/// The names of the parameters that Zoltan's partitioners read, but for those that zoltan_partition sets itself.
[[nodiscard]] const std::vector<std::string>& zoltan_parameter_names();

/// Whether Zoltan takes this parameter with this value. Some values it looks at only when it partitions.
[[nodiscard]] bool zoltan_accepts(const std::string& name, const std::string& value);

/// The part, 0 .. ranks - 1, of each listed subdomain: parts are as large as the ranks' speeds relative to each other,
/// measured in remaining work. It runs within this process and the same arguments give the same parts. Parts may be
/// empty. Initializes MPI if nobody has. Throws Error if Zoltan fails.
[[nodiscard]] std::vector<Part> zoltan_partition(const LoadSnapshot& snapshot, const ZoltanParameters& parameters);

/// The same by all processes of an MPI communicator, named by its Fortran handle, at the same time: each lists its own
/// subdomains, no one is listed twice, and the states of ranks are equal everywhere. Returns the parts of `own`. Waits
/// for the other processes.
[[nodiscard]] std::vector<Part> zoltan_partition(const LoadSnapshot& own, const ZoltanParameters& parameters,
                                                 int communicator);

}  // namespace driftmesh::balancer
