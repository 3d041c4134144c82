#pragma once

#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The bound on area with which refinement to `bounds`, whose own bound on area does not count, is forecast to make
/// about `count` > 0 triangles. It is `count`'s share of the domain where the forecast agrees with that, as it does if
/// little but the bound on area asks for triangles; otherwise it is found by the forecast, up to half a percent.
/// Where angles, sizes and regions ask for more than `count` by themselves, it is the area of the domain.
[[nodiscard]] double area_for_count(const Triangulation& mesh, const QualityBounds& bounds, double count);

/// A bound on area, and how many triangles refinement makes with it.
struct TriedArea {
  double area = 0;
  double triangles = 0;  ///< as made for trial, or as forecast if nothing was tried
};

/// Corrects the bound on area of `bounds`, as area_for_count found it, by trial: until refinement, in one piece, makes
/// `count` triangles up to some 5 percent, the bound is the area of the domain, or eight trials are over, of which the
/// best counts. Forecasts are that far off where few triangles meet many details. `mesh` has its corners prepared, and
/// `forecast` is how many triangles are expected of it. Nothing is tried above 100,000 triangles, where it takes long
/// and forecasts agree, and where the forecast is beyond twice `count`.
[[nodiscard]] TriedArea try_area_for_count(const Triangulation& mesh, const QualityBounds& bounds, double count,
                                           double forecast);

}  // namespace driftmesh
