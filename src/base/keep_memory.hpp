#pragma once

namespace driftmesh {

/// Makes the C library's allocator keep freed memory for the next allocation instead of returning it to the system, for
/// programs that constantly allocate and free arrays of a megabyte: a fresh page from the system costs a page fault and
/// is cleared first, which takes several times as long as copying to it. Call once, at the start. Has no effect if the
/// C library is not glibc.
void keep_freed_memory();

}  // namespace driftmesh
