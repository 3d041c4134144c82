#pragma once

#include <vector>

#include "job/key.hpp"

namespace driftmesh::job {

/// The declarations of all keys, in the order of their sections. For lookups see keys.hpp.
[[nodiscard]] std::vector<Key> all_keys();

}  // namespace driftmesh::job
