#pragma once

namespace driftmesh {

/// Asks the C library's allocator to keep what is freed for the next allocation instead of handing it back to the
/// system, for programs that make and drop arrays of a megabyte all the time: a page that comes back from the system
/// costs a fault and is cleared first, several times what copying to it costs. Call once, at the start. Without effect
/// where the C library is not glibc.
void keep_freed_memory();

}  // namespace driftmesh
