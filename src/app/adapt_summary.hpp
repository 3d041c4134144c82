#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/adapt_command.hpp"
#include "geometry/box.hpp"
#include "job/watch.hpp"
#include "patch/remake.hpp"
#include "patch/unmet.hpp"

namespace driftmesh::app {

/// What driftmesh adapt did, in lines that end in '\n'. `before`: triangles of the old mesh; `unmet`: empty if nothing
/// was compared.
[[nodiscard]] std::string adapt_summary(const patch::Remade& remade, const patch::Unmet& unmet, std::size_t before,
                                        const AdaptCommand& command, const std::vector<job::StageTime>& stages);

/// Where both domains are, as a warning, if no two neighboring points stay (one may be in both by chance); otherwise
/// empty. `before`: around the old mesh.
[[nodiscard]] std::string warning_if_nothing_stays(const patch::Remade& remade, const Box& before,
                                                   const AdaptCommand& command);

}  // namespace driftmesh::app
