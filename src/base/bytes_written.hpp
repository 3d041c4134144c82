#pragma once

#include <cstdint>

namespace driftmesh {

/// How many bytes of large files this process has written since it began, to show progress. What is in buffers is not
/// counted yet.
[[nodiscard]] std::uint64_t bytes_written() noexcept;

}  // namespace driftmesh
