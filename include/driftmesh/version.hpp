#pragma once

// The one place that states the version: the build, the packages and the program take it from here, and a test compares
// CHANGELOG.md and CITATION.cff with it. Versions follow semver.org; before 1.0 a new minor version may break callers.
#define DRIFTMESH_VERSION_MAJOR 0
#define DRIFTMESH_VERSION_MINOR 2
#define DRIFTMESH_VERSION_PATCH 0

#define DRIFTMESH_QUOTE_(a, b, c) #a "." #b "." #c
#define DRIFTMESH_QUOTED_(a, b, c) DRIFTMESH_QUOTE_(a, b, c)
/// "0.2.0"
///
/// \code
/// static_assert(DRIFTMESH_VERSION_MAJOR == 0 && DRIFTMESH_VERSION_MINOR >= 2);
/// std::cout << "built with driftmesh " DRIFTMESH_VERSION "\n";
/// \endcode
#define DRIFTMESH_VERSION DRIFTMESH_QUOTED_(DRIFTMESH_VERSION_MAJOR, DRIFTMESH_VERSION_MINOR, DRIFTMESH_VERSION_PATCH)
