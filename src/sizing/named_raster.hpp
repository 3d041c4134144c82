#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sizing/plane_function.hpp"

namespace driftmesh {

class Raster;

/// A raster, or another function, that size expressions call by a name.
struct NamedRaster {
  std::string name;
  std::shared_ptr<const Raster> raster;
  std::shared_ptr<const PlaneFunction> function{};  ///< in place of a raster
};
using NamedRasters = std::vector<NamedRaster>;

/// Whether a raster may have this name: letters, digits and underscores, not a digit first, and nothing that
/// expressions already know.
[[nodiscard]] bool can_name_raster(std::string_view name);

/// The values of a raster.
[[nodiscard]] std::shared_ptr<const PlaneFunction> values_of(std::shared_ptr<const Raster> raster);
/// The slope of a raster.
[[nodiscard]] std::shared_ptr<const PlaneFunction> slope_of(const std::shared_ptr<const Raster>& raster);

}  // namespace driftmesh
