#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/ids.hpp"

namespace driftmesh::protocol {

/// How many times a subdomain has moved: 0 where the initial mapping put it.
using Epoch = std::uint32_t;

using Bytes = std::vector<std::byte>;

}  // namespace driftmesh::protocol
