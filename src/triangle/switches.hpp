#pragma once

#include <cstdint>
#include <string_view>

#include "mesh/bounds.hpp"

namespace driftmesh::triangle {

/// What Triangle's switches ask for.
struct Switches {
  bool pslg = false;               ///< p: segments, holes and regions count
  bool refine = false;             ///< r: the input is a mesh
  bool quality = false;            ///< q, a, u, D or s: points may be added
  double min_angle = 0;            ///< q: degrees
  double max_area = 0;             ///< a with a number; 0: no bound
  bool given_areas = false;        ///< a without a number: bounds of regions or of triangles
  bool unsuitable = false;         ///< u: the caller says which triangles are too large
  InsertionRules rules{};          ///< D and s, Y, S
  bool region_attributes = false;  ///< A, with p and without r
  bool hull = false;               ///< c: the convex hull is part of the input
  bool jettison = false;           ///< j: points in no triangle are left out
  bool edges = false;              ///< e
  bool voronoi = false;            ///< v
  bool neighbors = false;          ///< n
  bool second_order = false;       ///< o2
  bool check = false;              ///< C
  bool no_holes = false;           ///< O
  bool no_markers = false;         ///< B
  bool no_segments = false;        ///< P
  bool no_points = false;          ///< N
  bool no_triangles = false;       ///< E
  bool no_iteration = false;       ///< I: file names get no number
  bool geomview = false;           ///< g: an .off file
  bool from_zero = false;          ///< z
  bool quiet = false;              ///< Q
  bool verbose = false;            ///< V
  bool help = false;               ///< h
};

/// Reads switches, with or without dashes: "pq30a0.1Dn". Numbers follow q, a, o and S at once; they have digits, a
/// point and, if it has a sign, an exponent ("a1e-05"). i, F, l and X choose between ways to the same triangulation and
/// change nothing. Throws Error, which names the switch, for letters that Triangle does not know, those that driftmesh
/// does not offer, and numbers out of range.
[[nodiscard]] Switches parse_switches(std::string_view text);

}  // namespace driftmesh::triangle
