#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace driftmesh::protocol {

/// A process of the parallel run: 0 .. ranks - 1.
using Rank = std::int32_t;
/// A subdomain of the decomposition: 0 .. subdomains - 1, the same on every rank.
using SubdomainId = std::int32_t;
/// An edge that two subdomains share, by its number in the decomposition: the same on every rank.
using EdgeId = std::int32_t;
/// How many times a subdomain has moved: 0 where the initial mapping put it.
using Epoch = std::uint32_t;

using Bytes = std::vector<std::byte>;

}  // namespace driftmesh::protocol
