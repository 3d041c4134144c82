#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "decompose/bridges.hpp"
#include "decompose/pieces.hpp"
#include "support/prepared_mesh.hpp"

// How parts are dealt to pieces, and pieces joined: of a row of rectangles with walls between them, work is the width.

using namespace driftmesh;

namespace {

/// Rectangles of these widths, and of height 1, from left to right.
struct RowOfPieces {
  explicit RowOfPieces(const std::vector<double>& of_widths) : widths(of_widths) {
    Pslg pslg;
    pslg.points = {{0, 0}, {0, 1}};
    pslg.segments = {{0, 1, 1}};
    double x = 0;
    for (const double width : widths) {
      x += width;
      const auto low = static_cast<std::int32_t>(pslg.points.size()), high = low + 1;
      pslg.points.push_back({x, 0});
      pslg.points.push_back({x, 1});
      for (const auto& [a, b] : {std::pair(low - 2, low), {high - 2, high}, {low, high}})
        pslg.segments.push_back({a, b, 1});
    }
    map = connected_walls(testing::prepared(pslg), 10, 1);
    pieces = find_pieces(map, QualityBounds{});
    REQUIRE(pieces.size() == widths.size());
  }

  /// The piece with the k-th width, no two of which are the same.
  [[nodiscard]] PieceId piece(std::size_t k) const {
    for (const PieceId i : ids_of(pieces))
      if (std::fabs(pieces[i].area - widths[k]) < 1e-9) return i;
    FAIL("there is no such piece");
    return kNone;
  }

  std::vector<double> widths;
  PlanarMap map;
  IdVector<PieceId, Piece> pieces;
};

std::vector<std::int32_t> allotted(RowOfPieces row, std::int32_t parts) {
  allot_parts(row.map, row.pieces, parts);
  std::vector<std::int32_t> of_each;
  for (std::size_t k = 0; k < row.widths.size(); ++k) of_each.push_back(row.pieces[row.piece(k)].parts);
  return of_each;
}

/// For each of the row but the first whether it is in the group of the one before.
std::vector<bool> joined_to_last(const RowOfPieces& row, std::int32_t count) {
  const IdVector<PieceId, SubdomainId> group_of = group_pieces(row.map, row.pieces, count);
  std::vector<bool> joined;
  for (std::size_t k = 1; k < row.widths.size(); ++k)
    joined.push_back(group_of[row.piece(k)] == group_of[row.piece(k - 1)]);
  return joined;
}

}  // namespace

TEST_CASE("a part that is left over goes to the piece with the largest remainder") {
  CHECK(allotted(RowOfPieces({1.9, 1.1, 1}), 4) == std::vector<std::int32_t>{2, 1, 1});
  CHECK(allotted(RowOfPieces({1.1, 1, 1.9}), 4) == std::vector<std::int32_t>{1, 1, 2});
  CHECK(allotted(RowOfPieces({2.2, 0.5, 2.3}), 5) == std::vector<std::int32_t>{2, 1, 2});
}

TEST_CASE("the lightest piece is joined with its lightest neighbor") {
  CHECK(joined_to_last(RowOfPieces({3, 1, 2}), 2) == std::vector<bool>{false, true});
  CHECK(joined_to_last(RowOfPieces({2, 1, 3}), 2) == std::vector<bool>{true, false});
}

TEST_CASE("a group weighs as much as all its pieces") {
  // The first two, together 2.1, are joined first. Then the third is the lightest, and the fourth its lightest
  // neighbor.
  CHECK(joined_to_last(RowOfPieces({1, 1.1, 1.5, 1.6}), 2) == std::vector<bool>{true, false, true});
  CHECK(joined_to_last(RowOfPieces({1.6, 1.5, 1.1, 1}), 2) == std::vector<bool>{true, false, true});
}
