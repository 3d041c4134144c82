#pragma once

#include <map>
#include <string>

#include "driftmesh/generate.hpp"

namespace driftmesh {

// What generate_...() refuses before it makes anything: throws InputError.
void require_valid(const PipeOptions& options);
void require_valid(const CylinderFlowOptions& options);
void require_valid(const BayOptions& options);
void require_valid(const FanOptions& options);
void require_valid(const CombOptions& options);
void require_valid(const HolesOptions& options);
void require_valid(const RectangleHoleOptions& options);
void require_valid(const RandomPolygonOptions& options);
void require_valid(const RandomPointsOptions& options);

/// The same of an input by its name, and of parameters that it does not have, or whose values are no numbers.
void require_generated(const std::string& name, const std::map<std::string, std::string>& parameters);

// Visits the parameters of each generated input: visit(name, value, description), with their names in options and
// files.

template <class Visit>
void visit_parameters(PipeOptions& o, Visit&& visit) {
  visit("outer-radius", o.outer_radius, "Outer radius");
  visit("bore-radius", o.bore_radius, "Radius of the bore");
  visit("channels", o.channels, "Number of channels");
  visit("channel-depth", o.channel_depth, "Depth of a channel, along the radius");
  visit("channel-width", o.channel_width, "Width of a channel, along the circle");
  visit("fillet", o.fillet, "Radius of the rounded corners of a channel");
  visit("edge", o.edge, "Longest edge of the boundary");
}

template <class Visit>
void visit_parameters(CylinderFlowOptions& o, Visit&& visit) {
  visit("radius", o.radius, "Radius of the cylinder");
  visit("upstream", o.upstream, "Distance from the cylinder's center to the inflow");
  visit("downstream", o.downstream, "Distance from the cylinder's center to the outflow");
  visit("height", o.height, "Height of the half channel");
  visit("arc-edges", o.arc_edges, "Edges of the half circle");
  visit("edge", o.edge, "Longest edge of the other sides");
}

template <class Visit>
void visit_parameters(BayOptions& o, Visit&& visit) {
  visit("width", o.width, "Width of the region, in meters");
  visit("height", o.height, "Height of the region, in meters");
  visit("resolution", o.resolution, "Approximate distance between points of the coast, in meters");
  visit("roughness", o.roughness, "0: smooth coast, 1: very ragged");
  visit("seed", o.seed, "Different seeds make different bays");
}

template <class Visit>
void visit_parameters(FanOptions& o, Visit&& visit) {
  visit("wedges", o.wedges, "Number of angles");
  visit("angle", o.angle, "Each angle, in degrees");
  visit("corner", o.from_corner, "Start from a corner instead of the center");
}

template <class Visit>
void visit_parameters(CombOptions& o, Visit&& visit) {
  visit("slits", o.slits, "Number of slits");
  visit("pitch", o.pitch, "Distance between the slits");
  visit("width", o.width, "Width of a slit");
  visit("depth", o.depth, "Depth of a slit, below 1");
}

template <class Visit>
void visit_parameters(HolesOptions& o, Visit&& visit) {
  visit("columns", o.columns, "Holes in a row");
  visit("rows", o.rows, "Rows of holes");
  visit("sides", o.sides, "Sides of a hole");
  visit("radius", o.radius, "Radius of a hole, below 0.5");
  visit("jitter", o.jitter, "Random displacement of a hole in each axis");
  visit("seed", o.seed, "Seed of the displacements");
}

template <class Visit>
void visit_parameters(RectangleHoleOptions& o, Visit&& visit) {
  visit("sides", o.sides, "Sides of the hole");
  visit("radius", o.radius, "Radius of the hole, below 0.5");
}

template <class Visit>
void visit_parameters(RandomPolygonOptions& o, Visit&& visit) {
  visit("vertices", o.vertices, "Number of vertices");
  visit("jitter", o.jitter, "Largest displacement of a corner, below 0.5; edges have length 1");
  visit("seed", o.seed, "Different seeds make different polygons");
}

template <class Visit>
void visit_parameters(RandomPointsOptions& o, Visit&& visit) {
  visit("points", o.points, "Number of points, besides the corners of the square");
  visit("segments", o.segments, "Number of segments, at most a quarter of the points");
  visit("seed", o.seed, "Different seeds make different points");
}

}  // namespace driftmesh
