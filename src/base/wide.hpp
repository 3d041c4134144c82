#pragma once

/// Marks a function that is compiled twice where compiler and system allow it: for any processor, and for those with
/// wider vectors, which get theirs when the program starts. Its results are the same, as no operations are contracted.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DRIFTMESH_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define DRIFTMESH_WIDE
#endif
