#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"

namespace driftmesh {

// Parametric inputs for demonstrations, tests and benchmarks. Each depends on its options alone (including the seed, if
// it has one) and is planar: repair() finds nothing to do. Throw InputError for options that are out of range or make
// the shape overlap itself. Boundaries are counterclockwise, holes clockwise, and every hole has a seed.

/// Cross-section of a regeneratively cooled pipe: a ring with cooling channels in its wall. Markers: 1 outside, 2 bore,
/// 3, 4, ... channels. Lengths in one unit, say 0.1 mm.
struct PipeOptions {
  double outer_radius = 300;
  double bore_radius = 120;
  std::int32_t channels = 8;
  double channel_depth = 90;   ///< radial; channels lie in the middle of the wall
  double channel_width = 110;  ///< along the circle through their middle
  double fillet = 25;          ///< radius of the rounded corners of a channel
  double edge = 7.5;           ///< longest edge of the boundary
};
[[nodiscard]] Pslg generate_pipe(const PipeOptions& options);

/// Half of the channel around a cylinder at the origin: flow along x, the axis y = 0 is the symmetry line. Markers:
/// 1 inflow, 2 outflow, 3 top, 4 symmetry line, 5 cylinder.
struct CylinderFlowOptions {
  double radius = 0.5;
  double upstream = 15;    ///< length from the center to the inflow
  double downstream = 35;  ///< length from the center to the outflow
  double height = 28;
  std::int32_t arc_edges = 128;  ///< edges of the half circle
  double edge = 1;               ///< longest edge of the rest of the boundary
};
[[nodiscard]] Pslg generate_cylinder_flow(const CylinderFlowOptions& options);

/// A square of side 1 with segments that leave one point at small angles. Markers: 1 square, 2 fan.
struct FanOptions {
  std::int32_t wedges = 30;
  double angle = 1;  ///< degrees per wedge
  bool from_corner = false;
};
[[nodiscard]] Pslg generate_fan(const FanOptions& options);

/// A rectangle of height 1 with thin slits cut into it from above. Markers: 1 rectangle, 2 slits.
struct CombOptions {
  std::int32_t slits = 40;
  double pitch = 0.1;   ///< distance between slits
  double width = 1e-3;  ///< width of a slit
  double depth = 0.9;
};
[[nodiscard]] Pslg generate_comb(const CombOptions& options);

/// A plate with columns x rows holes, regular polygons in unit cells. Markers: 1 plate, 2 holes.
struct HolesOptions {
  std::int32_t columns = 20;
  std::int32_t rows = 10;
  std::int32_t sides = 12;
  double radius = 0.3;
  double jitter = 0.1;  ///< random displacement of a hole in each axis
  std::uint64_t seed = 1;
};
[[nodiscard]] Pslg generate_holes(const HolesOptions& options);

/// A 2 x 1 rectangle with a regular polygon as a hole in its middle. Markers: 1 rectangle, 2 hole.
struct RectangleHoleOptions {
  std::int32_t sides = 32;
  double radius = 0.25;
};
[[nodiscard]] Pslg generate_rectangle_hole(const RectangleHoleOptions& options);

/// A random simple polygon: a labyrinth without loops, its corners displaced. Marker 1. Edges have length about 1.
struct RandomPolygonOptions {
  std::int32_t vertices = 1000;
  double jitter = 0.3;  ///< largest displacement of a corner in each axis, below 0.5
  std::uint64_t seed = 1;
};
[[nodiscard]] Pslg generate_random_polygon(const RandomPolygonOptions& options);

/// Random points in the unit square, some joined by short segments that do not cross. Markers: 1 square, 2 segments.
struct RandomPointsOptions {
  std::int32_t points = 100000;   ///< all but the corners of the square
  std::int32_t segments = 10000;  ///< all but its sides; at most a quarter of the points
  std::uint64_t seed = 1;
};
[[nodiscard]] Pslg generate_random_points(const RandomPointsOptions& options);

/// A bay with inlets, an estuary and islands; lengths in meters. Markers: 1 coast, 2 open sea, 3, 4, ... islands.
struct BayOptions {
  double width = 60e3;
  double height = 90e3;
  double resolution = 100;  ///< approximate distance between points of the coast
  double roughness = 0.5;   ///< 0: smooth coast, 1: very ragged
  std::uint64_t seed = 1;
};
[[nodiscard]] Pslg generate_bay(const BayOptions& options);

/// The names of all inputs that can be generated: "pipe", "cylinder-flow", ...
[[nodiscard]] std::vector<std::string> generator_names();

/// A parameter of a generated input.
struct GeneratorParameter {
  std::string name;      ///< "outer-radius"
  std::string standard;  ///< its default
  std::string help;      ///< one line
};
/// Those of the input with this name. Throws InputError for an unknown name.
[[nodiscard]] std::vector<GeneratorParameter> generator_parameters(const std::string& name);

/// A generated input by its name and the values of some of its parameters, as in `driftmesh generate`: {{"seed", "7"}}.
/// Throws InputError for unknown names (with the nearest known one), values that are not numbers, and parameters that
/// the generator refuses.
///
/// \code
/// const driftmesh::Pslg bay = driftmesh::generate("bay", {{"seed", "7"}, {"resolution", "400"}});
/// const driftmesh::Pslg plate = driftmesh::generate_holes({.columns = 4, .rows = 3});
/// assert(plate.holes.size() == 12);
/// \endcode
[[nodiscard]] Pslg generate(const std::string& name, const std::map<std::string, std::string>& parameters = {});

}  // namespace driftmesh
