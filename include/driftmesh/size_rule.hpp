#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "driftmesh/point.hpp"
#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// Values on a regular grid: values[j * columns + i] at (x0 + i * dx, y0 + j * dy), bilinear in between and that of the
/// nearest point of the grid outside. NaN is a gap, which the nearest value fills.
struct GridValues {
  std::vector<float> values{};
  std::int64_t columns = 0;  ///< at least 2, and as many rows
  double x0 = 0, y0 = 0;
  double dx = 1, dy = 1;  ///< not 0; negative where values run from east to west, or from north to south
};

/// A rule for target edge lengths that the library evaluates by itself, on any number of threads: distances, widths,
/// rasters, lengths at the points of a mesh, and formulas of them. It is compiled for a domain once that is known, like
/// the size expressions of the program, with the same guarantees. Pass it as MeshOptions::size. Cheap to copy.
///
/// Functions and operators throw Error for what can be no part of a rule; what is wrong with a formula is found when a
/// mesh is made (InputError).
///
/// \code
/// using driftmesh::SizeRule;
/// const SizeRule shores = 0.02 + 0.1 * SizeRule::distance();
/// const SizeRule rule = min(shores, SizeRule::expression("0.05 + 0.2*abs(x - 1)")).limited({.gradation = 0.2});
/// const driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::generate("rectangle-hole"), {.size = rule});
/// \endcode
class SizeRule {
 public:
  /// Rules that an expression calls by names of letters, digits and underscores.
  using Named = std::vector<std::pair<std::string, SizeRule>>;

  /// The same everywhere.
  SizeRule(double length);
  /// A formula in x, y and named rules: docs/size-expressions.md.
  [[nodiscard]] static SizeRule expression(const std::string& formula, const Named& named = {});
  /// The distance to the nearest segment of the domain with one of these markers; no markers: to any segment.
  [[nodiscard]] static SizeRule distance(const std::vector<std::int32_t>& markers = {});
  /// The distance to the nearest of some segments, wherever they lie. At least one.
  [[nodiscard]] static SizeRule distance_to(const std::vector<std::array<Point, 2>>& segments);
  /// The local width of the domain.
  [[nodiscard]] static SizeRule width();
  /// The curvature of the outline.
  [[nodiscard]] static SizeRule curvature();
  [[nodiscard]] static SizeRule raster(const GridValues& grid);
  /// The length of its gradient.
  [[nodiscard]] static SizeRule slope(const GridValues& grid);
  /// Lengths at the points of a mesh: see size_on_mesh.
  [[nodiscard]] static SizeRule on_mesh(const Mesh& mesh, std::vector<double> lengths, double gradation = 0);
  /// A function of the caller, known at points alone: as MeshOptions::size, but also called at points near the domain,
  /// where it may return NaN.
  [[nodiscard]] static SizeRule function(std::function<double(const Point&)> function);

  /// What applies to all of a rule, in the end.
  struct Limits {
    double gradation = 0;  ///< by how much lengths may grow per unit of distance, along straight lines; 0: no limit
    double shortest = 0;
    double longest = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] SizeRule limited(const Limits& limits) const;

  friend SizeRule operator+(const SizeRule& a, const SizeRule& b);
  friend SizeRule operator-(const SizeRule& a, const SizeRule& b);
  friend SizeRule operator*(const SizeRule& a, const SizeRule& b);
  friend SizeRule operator/(const SizeRule& a, const SizeRule& b);
  friend SizeRule min(const SizeRule& a, const SizeRule& b);
  friend SizeRule max(const SizeRule& a, const SizeRule& b);

  /// The formula, in which what has no name of its own has a made one.
  [[nodiscard]] const std::string& formula() const;
  /// Its value at a point. Throws InputError if it is not positive, and for what depends on a domain.
  [[nodiscard]] double operator()(const Point& p) const { return field().edge_length(p); }
  /// The same as a size field, which lives as long as the rule.
  [[nodiscard]] const SizeField& field() const;
  /// Whether it calls a function of the caller, which may not be made for several threads.
  [[nodiscard]] bool calls_back() const;

 private:
  struct Parts;
  explicit SizeRule(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
  static SizeRule call(const std::string& name, const SizeRule& a, const SizeRule& b);
  static SizeRule joined(const std::string& formula, const std::vector<SizeRule>& rules);

  std::shared_ptr<const Parts> parts_;
};

}  // namespace driftmesh
