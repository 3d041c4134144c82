#include "sizing/least_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/mix.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kTableSize = std::size_t{1} << 14;
/// Cells are divided until they are this much smaller than the triangle, where it matters.
constexpr double kFinest = 1.0 / 32;
/// How many of them are divided further, how often, and how many cells each of these dives may look at.
constexpr int kMostDives = 32;
constexpr int kDeepestDive = 24;
constexpr int kCellsOfDive = 2 * kDeepestDive;
/// How many times as wide as a triangle the cells are that are looked at first, as exponents of two. The wider ones,
/// which many triangles share, answer for nearly all where lengths change little.
constexpr int kNear = 4, kBeside = 2;
/// Tells the exponents of cells with what is around them from others.
constexpr int kAround = 1 << 16;

/// Whether all of the box lies to the right of ab.
bool right_of(const Point& a, const Point& b, const Box& box) {
  // The corner that is farthest to the left.
  const Point p{b.y > a.y ? box.low.x : box.high.x, b.x > a.x ? box.high.y : box.low.y};
  return rounded_cross(a, b, p) < 0;
}

bool meet(const CornerPoints& t, const Box& bounds, const Box& box) {
  return bounds.overlaps(box) && !right_of(t[0], t[1], box) && !right_of(t[1], t[2], box) && !right_of(t[2], t[0], box);
}

}  // namespace

// ---- Cells ----

namespace {

/// 2^exponent, for exponents in the range of lengths of triangles.
double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// The least exponent of a power of two above a length.
int exponent_above(double length) {
  return static_cast<int>(std::bit_cast<std::uint64_t>(length) >> 52) - 1022;
}

std::int64_t index_at(double x, double scale) {
  const double cell = x * scale;
  const auto whole = static_cast<std::int64_t>(cell);
  return whole - (cell < static_cast<double>(whole) ? 1 : 0);
}

}  // namespace

double LeastSearch::Cell::width() const {
  return power_of_two(exponent);
}

Box LeastSearch::Cell::box() const {
  const double w = width();
  return {{static_cast<double>(i) * w, static_cast<double>(j) * w},
          {static_cast<double>(i + 1) * w, static_cast<double>(j + 1) * w}};
}

bool LeastSearch::Cell::is_smallest() const {
  constexpr std::int64_t kMost = std::int64_t{1} << 51;
  return std::max({i, j, -i, -j}) > kMost;
}

std::array<LeastSearch::Cell, 4> LeastSearch::Cell::quarters() const {
  const Cell first{2 * i, 2 * j, exponent - 1};
  std::array<Cell, 4> all{first, first, first, first};
  ++all[1].i;
  ++all[2].j;
  ++all[3].i;
  ++all[3].j;
  return all;
}

LeastSearch::Cell LeastSearch::Cell::around(const Point& p, int exponent) {
  const double scale = power_of_two(-exponent);
  return {index_at(p.x, scale), index_at(p.y, scale), exponent};
}

LeastSearch::Cell LeastSearch::Cell::first_of_cover(const Box& box) {
  return around(box.low, exponent_above(std::max(box.high.x - box.low.x, box.high.y - box.low.y)));
}

// ---- The search ----

struct LeastSearch::Question {
  const SizeField& field;
  const CornerPoints& triangle;
  Box bounds;
  double counts, tolerated;
  double finest;  // width of cells
  int dives = kMostDives;
  int cells_left = 0;  // cells for the present dive

  [[nodiscard]] bool meets(const Cell& cell) const { return meet(triangle, bounds, cell.box()); }
  [[nodiscard]] bool counts_at(const Point& p) const { return contains(triangle, p) && field.edge_length(p) < counts; }
  /// Where the function rises or falls all over the cell, it is least at a corner.
  [[nodiscard]] bool counts_at_corners(const Cell& cell) const {
    const auto& [low, high] = cell.box();
    return counts_at(low) || counts_at({high.x, low.y}) || counts_at({low.x, high.y}) || counts_at(high);
  }
};

LeastSearch::LeastSearch(std::function<double(const Box&)> lower_bound, double spacing)
    : lower_bound_(std::move(lower_bound)), spacing_(spacing), known_(kTableSize) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  least_ = lower_bound_({{-kFar, -kFar}, {kFar, kFar}});
}

/// Consecutive cells lie side by side in the table.
LeastSearch::Known& LeastSearch::place_of(const Cell& cell) {
  const auto i = static_cast<std::uint64_t>(cell.i), j = static_cast<std::uint64_t>(cell.j);
  const auto level = static_cast<std::uint64_t>(cell.exponent);
  return known_[(((i ^ (level * kMixStep)) * kMixStep >> 32) + j * 0x2545F491U) % kTableSize];
}

double LeastSearch::lower_bound(const Cell& cell) {
  Known& known = place_of(cell);
  if (known.cell != cell) known = {cell, lower_bound_(cell.box())};
  return known.bound;
}

/// The bound over a cell and an eighth of its width all around.
double LeastSearch::bound_around(const Cell& cell) {
  const Cell name{cell.i, cell.j, cell.exponent + kAround};
  Known& known = place_of(name);
  if (known.cell == name) return known.bound;
  const Box box = cell.box();
  const double margin = cell.width() / 8;
  known = {name, lower_bound_({{box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin}})};
  return known.bound;
}

/// The cell around the middle of a box that is more than 2^wider times as wide.
LeastSearch::Cell LeastSearch::cell_around(const Box& box, int wider) {
  const int exponent = exponent_above(std::max(box.high.x - box.low.x, box.high.y - box.low.y)) + wider;
  return Cell::around(box.center(), exponent);
}

double LeastSearch::least_near(const CornerPoints& triangle) {
  const Cell cell = cell_around(Box::of(triangle), kNear);
  Known& latest = latest_[cell.exponent % 2 == 0 ? 0 : 1];
  if (latest.cell != cell) latest = {cell, bound_around(cell)};
  return latest.bound;
}

bool LeastSearch::is_below(const SizeField& field, const CornerPoints& triangle, double length) {
  const double enough = kTolerated * length;
  const Box bounds = Box::of(triangle);
  if (least_ >= enough || least_near(triangle) >= enough || bound_around(cell_around(bounds, kBeside)) >= enough)
    return false;
  Question question{field, triangle, bounds, kCounts * length, enough, 0};
  return descend_from_cover(question);
}

/// From cells about as large as the triangle, up to four of which cover it.
bool LeastSearch::descend_from_cover(Question& question) {
  const auto& [low, high] = question.bounds;
  const double side = std::max(high.x - low.x, high.y - low.y);
  question.finest = std::min(side * kFinest, spacing_);
  const int exponent = exponent_above(side);
  const double scale = power_of_two(-exponent);
  for (std::int64_t j = index_at(low.y, scale); j <= index_at(high.y, scale); ++j)
    for (std::int64_t i = index_at(low.x, scale); i <= index_at(high.x, scale); ++i)
      if (descend(question, {i, j, exponent})) return true;
  return false;
}

/// Looks at the cells in which the bound leaves the question open.
bool LeastSearch::descend(Question& question, const Cell& cell) {
  if (lower_bound(cell) >= question.tolerated || !question.meets(cell)) return false;
  if (question.counts_at(cell.box().center())) return true;
  if (cell.width() <= question.finest || cell.is_smallest())
    return question.counts_at_corners(cell) || start_dive(question, cell);
  for (const Cell& quarter : cell.quarters())
    if (descend(question, quarter)) return true;
  return false;
}

/// Follows the lowest bound from one of the smallest cells: where values change steeply, it leads to the least.
bool LeastSearch::start_dive(Question& question, const Cell& cell) {
  if (question.dives == 0) return false;
  --question.dives;
  question.cells_left = kCellsOfDive;
  return dive(question, cell, 0);
}

/// Turns back where what is low lies outside the triangle.
bool LeastSearch::dive(Question& question, const Cell& cell, int depth) {
  if (depth == kDeepestDive || cell.is_smallest()) return false;
  std::array<std::pair<double, Cell>, 4> quarters;
  const std::array<Cell, 4> cells = cell.quarters();
  std::transform(cells.begin(), cells.end(), quarters.begin(),
                 [&](const Cell& quarter) { return std::pair(lower_bound(quarter), quarter); });
  std::stable_sort(quarters.begin(), quarters.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [bound, quarter] : quarters) {
    if (bound >= question.tolerated || question.cells_left == 0) return false;
    if (!question.meets(quarter)) continue;
    --question.cells_left;
    if (question.counts_at(quarter.box().center()) || question.counts_at_corners(quarter)) return true;
    if (dive(question, quarter, depth + 1)) return true;
  }
  return false;
}

}  // namespace driftmesh
