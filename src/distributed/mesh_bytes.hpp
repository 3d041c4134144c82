#pragma once

#include "base/bytes.hpp"
#include "distributed/exchange.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// A mesh, or a piece of one, as ranks of one run send it to each other.
[[nodiscard]] Bytes mesh_to_bytes(const Mesh& mesh);
/// Throws ProtocolError, naming the sender, for a message that is none.
[[nodiscard]] Mesh mesh_of(const Mail& mail);

}  // namespace driftmesh
