#pragma once

#include <cstdint>

#include "driftmesh/id_vector.hpp"

// A triangulation identifies its parts by their slots in its arrays. Each kind of part has a type of its own, so a
// triangle cannot be mistaken for one of its edges. kNone stands for none of any kind.
namespace driftmesh {

enum class VertexId : std::int32_t {};
enum class TriangleId : std::int32_t {};
enum class SubsegmentId : std::int32_t {};
enum class RootId : std::int32_t {};

/// The subsegment in the next slot.
[[nodiscard]] constexpr SubsegmentId after(SubsegmentId s) {
  return SubsegmentId{to_int(s) + 1};
}

/// A directed edge seen from one triangle, in one integer: 4 * triangle + i for the edge opposite to corner i. A
/// negative value c is not an edge but a constrained one's subsegment, ~c.
enum class HalfEdge : std::int32_t {};

[[nodiscard]] constexpr HalfEdge half_edge(TriangleId t, int i) {
  return HalfEdge{4 * to_int(t) + i};
}
[[nodiscard]] constexpr TriangleId triangle_of(HalfEdge h) {
  return TriangleId{to_int(h) >> 2};
}
[[nodiscard]] constexpr int index_of(HalfEdge h) {
  return to_int(h) & 3;
}
[[nodiscard]] constexpr bool is_constrained(HalfEdge h) {
  return to_int(h) < 0;
}
[[nodiscard]] constexpr SubsegmentId subsegment_of(HalfEdge h) {
  return SubsegmentId{~to_int(h)};
}
[[nodiscard]] constexpr HalfEdge constrained(SubsegmentId s) {
  return HalfEdge{~to_int(s)};
}
/// The corners of a triangle, or its edges, in their order: 0, 1, 2, and 0 again. Looked up in two bits each of a small
/// number, because a branch on a corner is one that no processor can predict.
[[nodiscard]] constexpr int next(int i) {
  return (0b00'10'01 >> (2 * i)) & 3;
}
[[nodiscard]] constexpr int previous(int i) {
  return (0b01'00'10 >> (2 * i)) & 3;
}

/// A half-edge must fit 31 bits.
inline constexpr std::int64_t kMaxTriangles = (std::int64_t{1} << 29) - 1;
/// Refinement stops at this many, since an insertion makes several at once.
inline constexpr std::int64_t kMostRefined = kMaxTriangles - 64;

/// The kind of a vertex in one integer: the index of a point of the input (small), ~s for the midpoint of subsegment s
/// (negative), or one of the large values below.
using VertexOrigin = std::int32_t;
/// Not on any segment: inserted by the refiner, which may delete it.
inline constexpr VertexOrigin kFree = INT32_MAX;
/// The slot of a deleted vertex, waiting for reuse.
inline constexpr VertexOrigin kDeleted = INT32_MAX - 1;
/// A corner of the box that the initial triangulation starts from.
inline constexpr VertexOrigin kFrame = INT32_MAX - 2;
/// kShellEnd + c: the end of a shell piece on circle c of an acute corner (see corners.hpp).
inline constexpr VertexOrigin kShellEnd = std::int32_t{1} << 30;

[[nodiscard]] constexpr bool is_input(VertexOrigin o) {
  return o >= 0 && o < kShellEnd;
}
[[nodiscard]] constexpr bool is_midpoint(VertexOrigin o) {
  return o < 0;
}
[[nodiscard]] constexpr bool is_shell_end(VertexOrigin o) {
  return o >= kShellEnd && o < kFrame;
}
/// The origin of the midpoint of subsegment s.
[[nodiscard]] constexpr VertexOrigin midpoint_of(SubsegmentId s) {
  return ~to_int(s);
}
/// The subsegment that a midpoint halves.
[[nodiscard]] constexpr SubsegmentId halved_by(VertexOrigin midpoint) {
  return SubsegmentId{~midpoint};
}

}  // namespace driftmesh
