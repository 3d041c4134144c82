#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/id_vector.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

// The triangles of a finished mesh in about one byte each, without their order. A depth-first walk over the mesh, to
// the right wherever possible, enters each triangle through an edge of a visited one; so only the corner opposite that
// edge needs to be coded. That is a vertex met for the first time, or most often the next vertex along the border of
// what the walk has covered. This is the idea of Edgebreaker (Rossignac 1999) and of the cut-border machine (Gumhold
// and Strasser 1998). Simpler here: the border is kept as a guess, one successor and one predecessor for each vertex,
// and a corner that the guess misses is given by its number. So holes, several components and vertices at which the
// border touches itself need no special cases.

/// An edge of the domain's border, with the domain on its left.
using BorderEdge = std::array<VertexId, 2>;

/// The border of the part of the domain that the walk has not covered, approximated by one edge from and to each
/// vertex.
class BorderGuess {
 public:
  BorderGuess(std::size_t vertices, std::span<const BorderEdge> border);
  [[nodiscard]] VertexId after(VertexId v) const { return after_[v]; }
  [[nodiscard]] VertexId before(VertexId v) const { return before_[v]; }
  /// The triangle left of a -> b with corner v is covered now.
  void cover(VertexId a, VertexId b, VertexId v);

 private:
  IdVector<VertexId, VertexId> after_, before_;  // kNone where nothing is known
};

/// Data needed in addition to the code to decode it.
struct CodedTriangles {
  Bytes code;
  std::int32_t triangles = 0;
  std::int32_t fixed = 0;     ///< vertices known beforehand have numbers below this
  std::int32_t vertices = 0;  ///< all; the others are numbered as the walk meets them
};

/// Codes the live triangles of `mesh`. `number` gives fixed vertices their numbers and is kNone for the others, which
/// receive theirs. `border` is that of the domain in these numbers, `entrances` are its half-edges; the walk starts
/// from each whose triangle it has not reached yet. Throws Error if it reaches some triangles from none of them.
[[nodiscard]] CodedTriangles encode_triangles(const Triangulation& mesh, IdVector<VertexId, VertexId>& number,
                                              std::int32_t fixed, std::span<const BorderEdge> border,
                                              std::span<const HalfEdge> entrances);

/// Calls visit(corners counterclockwise, region label) for each triangle, in the order of the walk. Throws Error for
/// code that encode_triangles did not make, if it would leave the range of vertices or triangles.
template <class Visit>
void decode_triangles(const CodedTriangles& coded, std::span<const BorderEdge> border, Visit&& visit);

namespace triangle_code {

enum Corner : std::uint8_t { kNew, kAfter, kBefore, kNamed };  // in the two low bits
inline constexpr std::uint8_t kCornerBits = 3;
inline constexpr std::uint8_t kGoesRight = 4;   // through the edge from the entrance's end to the corner
inline constexpr std::uint8_t kGoesLeft = 8;    // through the other edge, when all that is to the right is done
inline constexpr std::uint8_t kNewRegion = 16;  // another label than the triangle before: it follows
inline constexpr std::uint8_t kAllBits = 31;

}  // namespace triangle_code

template <class Visit>
void decode_triangles(const CodedTriangles& coded, std::span<const BorderEdge> border, Visit&& visit) {
  using namespace triangle_code;
  ByteReader in(coded.code);
  BorderGuess guess(to_index(coded.vertices), border);
  std::vector<BorderEdge> entrances;
  std::int32_t met = coded.fixed;
  std::uint16_t region = 0;
  const auto known = [&](std::uint64_t v) {
    if (v >= static_cast<std::uint64_t>(met)) throw Error("a triangle has a corner that is not known yet");
    return static_cast<VertexId>(v);
  };
  for (std::int32_t t = 0; t < coded.triangles; ++t) {
    if (entrances.empty()) {
      const VertexId a = known(in.varint());
      entrances.push_back({a, known(in.varint())});
    }
    const auto [a, b] = entrances.back();
    entrances.pop_back();
    const auto byte = in.number<std::uint8_t>();
    if (byte > kAllBits) throw Error("a triangle is coded in an unknown way");
    VertexId v = kNone;
    switch (byte & kCornerBits) {
      case kNew:
        if (met == coded.vertices) throw Error("there are more vertices than there should be");
        v = VertexId{met++};
        break;
      case kAfter:
        v = guess.after(b);
        break;
      case kBefore:
        v = guess.before(a);
        break;
      default:
        v = known(in.varint());
    }
    if (v == kNone) throw Error("a triangle has no corner");
    if ((byte & kNewRegion) != 0) {
      const std::uint64_t label = in.varint();
      if (label > UINT16_MAX) throw Error("a region label is out of range");
      region = static_cast<std::uint16_t>(label);
    }
    guess.cover(a, b, v);
    if ((byte & kGoesLeft) != 0) entrances.push_back({a, v});
    if ((byte & kGoesRight) != 0) entrances.push_back({v, b});
    visit(std::array<VertexId, 3>{a, b, v}, region);
  }
  if (!in.at_end() || !entrances.empty() || met != coded.vertices)
    throw Error("the triangles do not end where they should");
}

}  // namespace driftmesh
