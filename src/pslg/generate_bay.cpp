#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "driftmesh/generate.hpp"
#include "pslg/contour.hpp"
#include "pslg/generators.hpp"
#include "pslg/noise.hpp"
#include "pslg/seeded_random.hpp"
#include "pslg/shape_builder.hpp"

namespace driftmesh {
namespace {

constexpr double kLand = 1.5;            // value of a point far from water
constexpr std::size_t kLeastIsland = 5;  // grid points
constexpr std::size_t kFrameStride = 8;  // every kFrameStride-th point of the straight frame is kept

/// A point of a river's center line.
struct Reach {
  Point at;
  double half_width = 0;
};

/// A drowned river valley: a main stem that winds inland from its mouth and narrows, with branches of branches.
class Rivers {
 public:
  Rivers(const BayOptions& o, SeededRandom& random) : random_(random), unit_(std::min(o.width, o.height)) {
    grow({0.84 * o.width, 0.13 * o.height}, 0.62 * kPi, 0.095 * unit_, 0.95 * o.height, 0);
    grow({0.88 * o.width, 0.74 * o.height}, 0.9 * kPi, 0.025 * unit_, 0.25 * o.height, 2);
  }
  [[nodiscard]] const std::vector<Reach>& reaches() const { return reaches_; }

 private:
  void grow(Point at, double heading, double half_width, double length, int order) {
    const double mean = heading;
    double turn = 0, since_branch = 0, branch_after = half_width;
    int side = random_.below(2) == 0 ? 1 : -1;
    for (double done = 0; done < length;) {
      const double here = half_width * (1 - 0.93 * done / length);
      const double step = std::max(0.35 * here, 0.002 * unit_);
      reaches_.push_back({at, here});
      turn = 0.8 * turn + random_.uniform(-0.28, 0.28) - 0.06 * (heading - mean);
      heading += turn * std::min(1.0, step / (0.02 * unit_));
      at = {at.x + step * std::cos(heading), at.y + step * std::sin(heading)};
      done += step;
      since_branch += step;
      if (order < 4 && since_branch > branch_after && done < 0.9 * length) {
        const double angle = heading + side * random_.uniform(0.8, 1.35);
        // One after the other: compilers evaluate arguments in orders of their own.
        const double branch_length = (length - done) * random_.uniform(0.15, 0.45);
        const double branch_half_width = here * random_.uniform(0.25, 0.6);
        grow(at, angle, branch_half_width, branch_length, order + 1);
        side = -side;
        since_branch = 0;
        branch_after = random_.uniform(0.7, 2.2) * std::max(here, 0.016 * unit_);
      }
    }
  }

  SeededRandom& random_;
  double unit_;
  std::vector<Reach> reaches_;
};

// Lowers the grid to (distance to the center line of the river) / (half its width) - 1.
void carve(Grid& grid, const Reach& reach) {
  const double radius = (kLand + 1) * reach.half_width;
  const auto first = [&](double v) {
    return static_cast<std::size_t>(std::max(0.0, std::ceil((v - radius) / grid.spacing)));
  };
  const auto last = [&](double v, std::size_t count) {
    return static_cast<std::size_t>(
        std::clamp(std::floor((v + radius) / grid.spacing) + 1, 0.0, static_cast<double>(count)));
  };
  const std::size_t end_column = last(reach.at.x, grid.columns), end_row = last(reach.at.y, grid.rows);
  for (std::size_t row = first(reach.at.y); row < end_row; ++row)
    for (std::size_t column = first(reach.at.x); column < end_column; ++column) {
      const std::size_t i = grid.index(column, row);
      const Point p = grid.place(i);
      const double value = std::hypot(p.x - reach.at.x, p.y - reach.at.y) / reach.half_width - 1;
      grid.values[i] = std::min(grid.values[i], value);
    }
}

Grid make_grid(const BayOptions& o) {
  Grid grid;
  grid.spacing = o.resolution;
  grid.columns = static_cast<std::size_t>(std::floor(o.width / o.resolution)) + 1;
  grid.rows = static_cast<std::size_t>(std::floor(o.height / o.resolution)) + 1;
  grid.values.assign(grid.columns * grid.rows, kLand);
  return grid;
}

/// Below zero in the water: rivers and open sea, their shores displaced in proportion to the width of the water. On
/// most of the grid only the sign matters, and a few octaves of noise decide it.
class Terrain {
 public:
  explicit Terrain(const BayOptions& o)
      : o_(o),
        random_(o.seed),
        noise_(random_),
        islands_(random_),
        warp_x_(random_),
        warp_y_(random_),
        wave_(0.11 * unit()),
        octaves_(std::clamp(static_cast<int>(std::log2(wave_ / (2 * o.resolution))) + 1, 1, 12)),
        grid_(make_grid(o)) {}

  Grid make() {
    const Rivers rivers(o_, random_);
    for (const Reach& reach : rivers.reaches()) carve(grid_, reach);
    river_ = grid_.values;
    exact_.assign(grid_.values.size(), 0);
    for (std::size_t i = 0; i < grid_.values.size(); ++i) settle(i);
    for (std::size_t i = 0; i < grid_.values.size(); ++i)
      if (exact_[i] == 0 && at_shore(i)) grid_.values[i] = value(place(i));
    return std::move(grid_);
  }

 private:
  /// The part of the value that does not depend on the noise of the shore.
  struct Place {
    double base;  ///< the value without noise
    Point q;      ///< where noise is looked up
  };

  [[nodiscard]] double unit() const { return std::min(o_.width, o_.height); }
  [[nodiscard]] double gain() const { return 0.5 + 0.2 * o_.roughness; }
  [[nodiscard]] int island_octaves() const { return std::max(1, octaves_ - 1); }

  [[nodiscard]] Place place(std::size_t i) const {
    const Point p = grid_.place(i);
    const Point slow{p.x / (2.5 * wave_), p.y / (2.5 * wave_)};
    const double warp = warp_x_.fractal(slow, 3, 0.5);
    const double sea = (0.86 * o_.width + 0.10 * unit() * warp - p.x) / (0.07 * unit());
    return {std::clamp(std::min(river_[i], sea), -1.6, kLand),
            {p.x / wave_ + 0.35 * warp, p.y / wave_ + 0.35 * warp_y_.fractal(slow, 3, 0.5)}};
  }

  [[nodiscard]] double value(const Place& at) const {
    const double shore = noise_.fractal(at.q, octaves_, gain());
    const double shoal = islands_.fractal({2.5 * at.q.x, 2.5 * at.q.y}, island_octaves(), 0.5);
    return at.base + 2 * o_.roughness * shore + 10 * o_.roughness * std::max(0.0, shoal - kShoal);
  }

  /// A value of the right sign, exact if the sign is hard to tell.
  void settle(std::size_t i) {
    const Place at = place(i);
    const GradientNoise::Range shore = noise_.fractal_range(at.q, std::min(2, octaves_), octaves_, gain());
    const double least = at.base + 2 * o_.roughness * shore.low, most = at.base + 2 * o_.roughness * shore.high;
    const double shoal_to_emerge = kShoal - most / (10 * o_.roughness);
    if (least > kSure) {
      grid_.values[i] = least;
    } else if (most < -kSure && islands_.fractal_is_below(shoal_to_emerge - kSure, {2.5 * at.q.x, 2.5 * at.q.y},
                                                          island_octaves(), 0.5)) {
      grid_.values[i] = most;
    } else {
      grid_.values[i] = value(at);
      exact_[i] = 1;
    }
  }

  /// Whether a curve passes next to the point, so that its exact value matters.
  [[nodiscard]] bool at_shore(std::size_t i) const {
    const std::size_t column = i % grid_.columns, row = i / grid_.columns;
    const auto differs = [&](std::size_t k) { return grid_.negative(k) != grid_.negative(i); };
    return (column > 0 && differs(i - 1)) || (column + 1 < grid_.columns && differs(i + 1)) ||
           (row > 0 && differs(i - grid_.columns)) || (row + 1 < grid_.rows && differs(i + grid_.columns));
  }

  static constexpr double kShoal = 0.33;  // noise above this lifts the ground
  static constexpr double kSure = 1e-9;   // margin for rounding

  const BayOptions& o_;
  SeededRandom random_;
  const GradientNoise noise_, islands_, warp_x_, warp_y_;
  const double wave_;  // longest of the shore
  const int octaves_;
  Grid grid_;
  std::vector<double> river_;
  std::vector<char> exact_;
};

bool on_one_line(const Point& a, const Point& b, const Point& c) {
  return (a.x == b.x && b.x == c.x) || (a.y == b.y && b.y == c.y);
}

// The frame is straight: most of its vertices are redundant.
ContourLoop thinned(const ContourLoop& loop) {
  ContourLoop result{{}, loop.outside};
  const std::size_t n = loop.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const ContourLoop::Vertex &before = loop.vertices[(i + n - 1) % n], &here = loop.vertices[i],
                              &after = loop.vertices[(i + 1) % n];
    const bool straight =
        before.on_frame && here.on_frame && after.on_frame && on_one_line(before.at, here.at, after.at);
    if (!straight || i % kFrameStride == 0) result.vertices.push_back(here);
  }
  return result;
}

void add_shore(Pslg& pslg, const ContourLoop& loop, std::int32_t marker) {
  Chain chain;
  for (const ContourLoop::Vertex& v : loop.vertices) chain.push_back(v.at);
  const std::size_t first = pslg.segments.size();
  add_loop(pslg, chain, marker);
  for (std::size_t i = 0; i < chain.size(); ++i)
    if (loop.vertices[i].on_frame && loop.vertices[(i + 1) % chain.size()].on_frame)
      pslg.segments[first + i].marker = 2;
}

}  // namespace

void require_valid(const BayOptions& o) {
  const auto require = [](bool condition, const char* what) { require_option(condition, "bay", what); };
  require(o.width > 0 && o.height > 0 && o.width < 1e9 && o.height < 1e9,
          "width and height must be positive, below 1e9");
  require(o.resolution > 0 && o.resolution <= std::min(o.width, o.height) / 40,
          "the resolution must be positive and at most 1/40 of width and height");
  require(o.width / o.resolution * (o.height / o.resolution) < 2e8, "the resolution is too fine for 2e8 grid points");
  require(o.roughness >= 0 && o.roughness <= 1, "the roughness must be 0 to 1");
}

Pslg generate_bay(const BayOptions& o) {
  require_valid(o);
  Grid terrain = Terrain(o).make();
  keep_main_basin(terrain, kLeastIsland);
  Pslg pslg;
  std::int32_t island = 3;
  std::vector<ContourLoop> loops = trace_contours(terrain);
  // The one counterclockwise loop is the coast of the basin.
  std::stable_partition(loops.begin(), loops.end(), [](const ContourLoop& l) { return twice_signed_area(l) > 0; });
  for (const ContourLoop& loop : loops) {
    if (twice_signed_area(loop) > 0) {
      add_shore(pslg, thinned(loop), 1);
      continue;
    }
    add_shore(pslg, loop, island++);
    pslg.holes.push_back(loop.outside);
  }
  return checked(std::move(pslg), "bay");
}

}  // namespace driftmesh
