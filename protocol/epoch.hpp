#pragma once

#include <cstdint>

namespace driftmesh::protocol {

/// How many times a subdomain has moved: 0 where the initial mapping put it.
using Epoch = std::uint32_t;

}  // namespace driftmesh::protocol
