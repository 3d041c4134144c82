#pragma once

#include <memory>
#include <vector>

#include "sizing/plane_function.hpp"

namespace driftmesh {

/// A function between two bounds; -infinity or infinity where there is none. NaN stays NaN.
[[nodiscard]] std::shared_ptr<const PlaneFunction> limited(std::shared_ptr<const PlaneFunction> function, double least,
                                                           double most);

/// The least of several functions; NaN where one of them is. At least one.
[[nodiscard]] std::shared_ptr<const PlaneFunction> least_of(
    std::vector<std::shared_ptr<const PlaneFunction>> functions);

}  // namespace driftmesh
