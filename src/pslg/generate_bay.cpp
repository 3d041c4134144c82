#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "pslg/contour.hpp"
#include "pslg/generate.hpp"
#include "pslg/noise.hpp"
#include "pslg/seeded_random.hpp"
#include "pslg/shape_builder.hpp"

namespace driftmesh {
namespace {

constexpr double kLand = 1.5;            // value of a point far from water
constexpr std::size_t kLeastIsland = 5;  // grid points
constexpr std::size_t kFrameStride = 8;  // every so many points of the straight frame are kept

/// A place of a river's middle line.
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
        grow(at, angle, here * random_.uniform(0.25, 0.6), (length - done) * random_.uniform(0.15, 0.45), order + 1);
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

// Lowers the grid to (distance to the middle of the river) / (half its width) - 1.
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

/// Below zero in the water: rivers and open sea, their shores displaced in proportion to the width of the water.
Grid make_terrain(const BayOptions& o) {
  SeededRandom random(o.seed);
  const GradientNoise noise(random), islands(random), warp_x(random), warp_y(random);
  const double unit = std::min(o.width, o.height);
  Grid grid = make_grid(o);
  const Rivers rivers(o, random);
  for (const Reach& reach : rivers.reaches()) carve(grid, reach);
  const double wave = 0.11 * unit;  // longest wave of the shore
  const int octaves = std::clamp(static_cast<int>(std::log2(wave / (2 * o.resolution))) + 1, 1, 12);
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const Point p = grid.place(i);
    const Point slow{p.x / (2.5 * wave), p.y / (2.5 * wave)};
    const double sea = (0.86 * o.width + 0.10 * unit * warp_x.fractal(slow, 3, 0.5) - p.x) / (0.07 * unit);
    const Point q{p.x / wave + 0.35 * warp_x.fractal(slow, 3, 0.5), p.y / wave + 0.35 * warp_y.fractal(slow, 3, 0.5)};
    const double shore = noise.fractal(q, octaves, 0.5 + 0.2 * o.roughness);
    const double shoal = islands.fractal({2.5 * q.x, 2.5 * q.y}, std::max(1, octaves - 1), 0.5);
    grid.values[i] = std::clamp(std::min(grid.values[i], sea), -1.6, kLand) + 2 * o.roughness * shore +
                     10 * o.roughness * std::max(0.0, shoal - 0.33);
  }
  return grid;
}

bool on_one_line(const Point& a, const Point& b, const Point& c) {
  return (a.x == b.x && b.x == c.x) || (a.y == b.y && b.y == c.y);
}

// The frame is straight: most of its vertices say nothing.
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

void check_bay(const BayOptions& o) {
  const auto require = [](bool condition, const char* what) { require_option(condition, "bay", what); };
  require(o.width > 0 && o.height > 0 && o.width < 1e9 && o.height < 1e9,
          "width and height must be positive, below 1e9");
  require(o.resolution > 0 && o.resolution <= std::min(o.width, o.height) / 40,
          "the resolution must be positive and at most 1/40 of width and height");
  require(o.width / o.resolution * (o.height / o.resolution) < 2e8, "the resolution is too fine for 2e8 grid points");
  require(o.roughness >= 0 && o.roughness <= 1, "the roughness must be 0 to 1");
}

}  // namespace

Pslg generate_bay(const BayOptions& o) {
  check_bay(o);
  Grid terrain = make_terrain(o);
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
