#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>

#include "base/disjoint_sets.hpp"
#include "verify/domain.hpp"
#include "verify/edge_check.hpp"
#include "verify/findings.hpp"
#include "verify/frame.hpp"
#include "verify/number_runs.hpp"
#include "verify/point_index.hpp"
#include "verify/quality.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// What the check of a piece has to know besides the piece.
struct PieceOrder {
  const PointIndex* corners = nullptr;        ///< the points of the domain, or null
  std::span<const std::int64_t> shared = {};  ///< ascending: numbers of points that other pieces have, too
  const CheckedBounds* bounds = nullptr;      ///< to measure triangles by; null: they are not measured
  bool parts = false;                         ///< whether to find the parts that subsegments separate
  DelaunayRule delaunay{};
  std::size_t max_listed = 5;
  std::size_t threads = 1;
};

/// What was found in one piece of a mesh, or in a mesh in one piece.
struct PieceReport {
  Findings findings = Findings(0);
  bool computable = false;  ///< otherwise the rest is missing
  std::size_t points = 0;
  std::size_t triangles = 0;
  bool has_subsegments = false;
  std::size_t used_inside = 0;  ///< points that are not marked in the frame
  NumberRuns inside;            ///< their numbers
  std::set<std::int32_t> subdomains;
  Interfaces interfaces;
  Measures measures;
  Frame frame;
  std::optional<DisjointSets<std::int32_t>> parts;
};

/// Checks all that can be checked in a piece alone: its arrays, coordinates, the orientation of its triangles, the
/// edges in its inside, and bounds. What is left is in the frame.
[[nodiscard]] PieceReport check_piece(const NamedMesh& piece, const PieceOrder& order);

}  // namespace driftmesh
