#pragma once

#include <vector>

#include "adapt/linear_lengths.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "dyadic/path.hpp"

namespace driftmesh::adapt {

/// The points that refinement has put on a root of a subdomain, ascending, so each after its ancestors.
[[nodiscard]] std::vector<dyadic::Path> points_on(const Triangulation& mesh, RootId root);

/// The points that a shared root is to have, likewise: as presplit_paths (decompose/presplit.hpp), for lengths that are
/// linear between the points that it has. Both sides hold these with the same bits, so that they agree without a
/// message. `twice_area`: the smaller of the bounds of both sides by region.
[[nodiscard]] std::vector<dyadic::Path> points_wanted(const Triangulation& mesh, RootId root, const Lengths& lengths,
                                                      double twice_area);

/// Both, each once.
[[nodiscard]] std::vector<dyadic::Path> united(const std::vector<dyadic::Path>& some,
                                               const std::vector<dyadic::Path>& others);
/// Those that are not among the others.
[[nodiscard]] std::vector<dyadic::Path> without(const std::vector<dyadic::Path>& some,
                                                const std::vector<dyadic::Path>& others);

}  // namespace driftmesh::adapt
