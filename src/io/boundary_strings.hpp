#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh {

/// Consecutive edges of the boundary that are of one type and one part, with the domain on their left: counterclockwise
/// around the domain, clockwise around its islands.
struct BoundaryString {
  std::int32_t type = 0;
  bool closed = false;                 ///< a whole ring: the first vertex follows the last one
  std::vector<std::int32_t> vertices;  ///< each once; at least two
};

// The types that are told apart here; others are numbers of ADCIRC's (IBTYPE).
inline constexpr std::int32_t kOpenType = -1;
inline constexpr std::int32_t kMainlandType = 0;
inline constexpr std::int32_t kIslandType = 1;

/// Whether boundaries of the type are whole rings: 1, 11, 21.
[[nodiscard]] bool is_closed_type(std::int32_t type);

struct Boundary {
  std::vector<BoundaryString> strings;
  std::vector<std::int32_t> touched;  ///< vertices in which boundaries touch each other or themselves, ascending
};

/// What an edge of the boundary is of.
struct EdgeType {
  std::int32_t type = kMainlandType;
  std::int32_t part = 0;  ///< boundaries of one type that follow each other are two if their parts differ
  friend bool operator==(const EdgeType&, const EdgeType&) = default;
};

/// The type of the edge from `from` to `to`, with the index into mesh.edges, or -1 if it is not there.
using TypeOfEdge = std::function<EdgeType(std::int32_t from, std::int32_t to, std::int32_t edge)>;

/// The boundary of a mesh in strings, in the order of the first of their edges in mesh.edges. Each edge with a triangle
/// on one side only is in exactly one string. The strings make up rings that pass no vertex twice: islands that touch
/// the shore or each other are rings of their own.
///
/// A ring of one type is one closed string if it is an island: of type 1, 11 or 21, as is a ring of type 0 that runs
/// clockwise. Any other is two strings, joined at both ends, as is every ring of several types: its strings end where
/// the next one begins, and what is of an island's type is mainland (0, 10, 20) there.
[[nodiscard]] Boundary boundary_of(const Mesh& mesh, const TypeOfEdge& type_of);

}  // namespace driftmesh
