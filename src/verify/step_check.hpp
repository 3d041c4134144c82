#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"
#include "driftmesh/time_step.hpp"
#include "raster/raster.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// The Courant numbers of some triangles.
struct StepMeasures {
  struct Item {
    double courant;
    std::string words;
  };
  double greatest = 0;      ///< Courant number
  std::uint64_t above = 0;  ///< triangles above the bound
  std::vector<Item> worst;  ///< the worst of these

  void add(const StepMeasures& later, std::size_t max_listed);
};

/// Computes the Courant numbers of the triangles of a mesh from their corners and from depths.
class StepCheck {
 public:
  using Triangle = std::array<Point, 3>;

  /// The raster must outlive the object.
  StepCheck(const CourantRule& rule, const Raster& depth) : rule_(rule), depth_(depth) {}

  /// With the depth at the deepest point of the triangle.
  [[nodiscard]] double courant(const Triangle& triangle) const;
  [[nodiscard]] StepMeasures measure(const NamedMesh& mesh, std::size_t max_listed, std::size_t threads) const;

  /// Whether a triangle may be larger than the bounds on its size for the sake of the step: those that splitting made
  /// of it, or of its neighbors, could be too small.
  [[nodiscard]] bool spares(const Triangle& triangle) const;

 private:
  /// The length with which a triangle of this depth is at the bound.
  [[nodiscard]] double needed(double depth) const;

  CourantRule rule_;
  const Raster& depth_;
};

}  // namespace driftmesh
