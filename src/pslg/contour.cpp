#include "pslg/contour.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace driftmesh {
namespace {

constexpr std::uint32_t kNoPoint = 0xffffffff;

/// Connected sets of grid points with one sign.
struct Components {
  std::vector<std::uint32_t> label;  // for each point
  std::vector<std::size_t> size;     // for each component
  std::vector<char> negative;
  std::vector<char> on_frame;
};

// Negative points connect by sides, others by corners as well: then curves separate components exactly.
template <class Visit>
void visit_neighbors(const Grid& grid, std::size_t i, bool corners, Visit visit) {
  const auto column = static_cast<std::int64_t>(i % grid.columns), row = static_cast<std::int64_t>(i / grid.columns);
  for (std::int64_t dy = -1; dy <= 1; ++dy)
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      const std::int64_t x = column + dx, y = row + dy;
      if ((dx == 0 && dy == 0) || (!corners && dx != 0 && dy != 0)) continue;
      if (x < 0 || y < 0 || x >= static_cast<std::int64_t>(grid.columns) || y >= static_cast<std::int64_t>(grid.rows))
        continue;
      visit(grid.index(x, y));
    }
}

void flood(const Grid& grid, std::size_t start, Components& found) {
  const auto label = static_cast<std::uint32_t>(found.size.size());
  const bool negative = grid.negative(start);
  std::vector<std::size_t> open{start};
  std::size_t size = 0;
  bool on_frame = false;
  found.label[start] = label;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    ++size;
    on_frame = on_frame || grid.on_frame(i);
    visit_neighbors(grid, i, !negative, [&](std::size_t k) {
      if (found.label[k] != kNoPoint || grid.negative(k) != negative) return;
      found.label[k] = label;
      open.push_back(k);
    });
  }
  found.size.push_back(size);
  found.negative.push_back(negative);
  found.on_frame.push_back(on_frame);
}

Components components_of(const Grid& grid) {
  Components found;
  found.label.assign(grid.values.size(), kNoPoint);
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    if (found.label[i] == kNoPoint) flood(grid, i, found);
  return found;
}

void keep_largest_basin(Grid& grid) {
  const Components found = components_of(grid);
  std::size_t largest = found.size.size();
  for (std::size_t c = 0; c < found.size.size(); ++c)
    if (found.negative[c] && (largest == found.size.size() || found.size[c] > found.size[largest])) largest = c;
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    if (grid.negative(i) && found.label[i] != largest) grid.values[i] = -grid.values[i];
}

void drown_small_islands(Grid& grid, std::size_t least) {
  const Components found = components_of(grid);
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const std::uint32_t c = found.label[i];
    if (!found.negative[c] && !found.on_frame[c] && found.size[c] < least)
      grid.values[i] = std::min(-grid.values[i], -1e-3);
  }
}

/// Follows the curves. A curve's vertex lies on the side between two neighboring grid points and is identified by the
/// lower of them and the side's direction.
class Tracer {
 public:
  explicit Tracer(const Grid& grid) : grid_(grid), next_(2 * grid.values.size(), kNoPoint) {}

  std::vector<ContourLoop> run() {
    for (std::size_t row = 0; row + 1 < grid_.rows; ++row)
      for (std::size_t column = 0; column + 1 < grid_.columns; ++column) link_cell(column, row);
    std::vector<ContourLoop> loops;
    for (std::size_t start = 0; start < next_.size(); ++start)
      if (next_[start] != kNoPoint) loops.push_back(take_loop(static_cast<std::uint32_t>(start)));
    return loops;
  }

 private:
  // Going around the cell counterclockwise, a curve enters it where values turn from negative to positive and leaves it
  // where they last turned back, so that negative corners opposite to each other stay separate.
  void link_cell(std::size_t column, std::size_t row) {
    const std::array<std::size_t, 4> corner{grid_.index(column, row), grid_.index(column + 1, row),
                                            grid_.index(column + 1, row + 1), grid_.index(column, row + 1)};
    const std::array<std::uint32_t, 4> side{horizontal(corner[0]), vertical(corner[1]), horizontal(corner[3]),
                                            vertical(corner[0])};
    for (std::size_t s = 0; s < 4; ++s) {
      if (!grid_.negative(corner[s]) || grid_.negative(corner[(s + 1) % 4])) continue;
      std::size_t back = (s + 3) % 4;
      while (grid_.negative(corner[back])) back = (back + 3) % 4;
      next_[side[s]] = side[back];
    }
  }
  static std::uint32_t horizontal(std::size_t low) { return static_cast<std::uint32_t>(2 * low); }
  static std::uint32_t vertical(std::size_t low) { return static_cast<std::uint32_t>(2 * low + 1); }

  ContourLoop take_loop(std::uint32_t start) {
    ContourLoop loop;
    loop.outside = grid_.place(positive_end(start));
    for (std::uint32_t at = start; next_[at] != kNoPoint;) {
      loop.vertices.push_back(vertex(at));
      const std::uint32_t following = next_[at];
      next_[at] = kNoPoint;
      at = following;
    }
    return loop;
  }

  [[nodiscard]] std::size_t low_end(std::uint32_t side) const { return side / 2; }
  [[nodiscard]] std::size_t high_end(std::uint32_t side) const {
    return side / 2 + (side % 2 == 0 ? 1 : grid_.columns);
  }
  [[nodiscard]] std::size_t positive_end(std::uint32_t side) const {
    return grid_.negative(low_end(side)) ? high_end(side) : low_end(side);
  }
  [[nodiscard]] ContourLoop::Vertex vertex(std::uint32_t side) const {
    const std::size_t low = low_end(side), high = high_end(side);
    const bool on_frame = grid_.on_frame(low) || grid_.on_frame(high);
    const double a = grid_.values[low], b = grid_.values[high];
    const double t = on_frame ? 0.5 : std::clamp(a / (a - b), 0.15, 0.85);
    const Point p = grid_.place(low), q = grid_.place(high);
    return {{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)}, on_frame};
  }

  const Grid& grid_;
  std::vector<std::uint32_t> next_;
};

}  // namespace

void keep_main_basin(Grid& grid, std::size_t least) {
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    if (grid.on_frame(i)) grid.values[i] = 1;
  keep_largest_basin(grid);
  drown_small_islands(grid, least);
}

std::vector<ContourLoop> trace_contours(const Grid& grid) {
  return Tracer(grid).run();
}

double twice_signed_area(const ContourLoop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const Point &p = loop.vertices[i].at, &q = loop.vertices[(i + 1) % loop.vertices.size()].at;
    sum += p.x * q.y - p.y * q.x;
  }
  return sum;
}

}  // namespace driftmesh
