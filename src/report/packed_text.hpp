#pragma once

#include <cstddef>
#include <string>

namespace driftmesh {

/// Bytes compressed by zlib, as base64 (RFC 4648).
[[nodiscard]] std::string packed_text(const void* bytes, std::size_t count);

}  // namespace driftmesh
