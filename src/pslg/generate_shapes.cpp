#include <algorithm>
#include <cmath>
#include <string>

#include "driftmesh/generate.hpp"
#include "pslg/generators.hpp"
#include "pslg/seeded_random.hpp"
#include "pslg/shape_builder.hpp"

namespace driftmesh {
namespace {

Chain reversed(Chain chain) {
  std::reverse(chain.begin(), chain.end());
  return chain;
}

Chain circle(const Point& center, double radius, std::int32_t edges) {
  return arc(center, radius, 0, 2 * kPi, edges);
}

// A hole, clockwise, with its seed.
void add_hole(Pslg& pslg, const Chain& loop, const Point& seed, std::int32_t marker) {
  add_loop(pslg, reversed(loop), marker);
  pslg.holes.push_back(seed);
}

// A rectangle with rounded corners around the origin, counterclockwise.
Chain rounded_rectangle(double width, double height, double fillet, double edge) {
  const double x = width / 2 - fillet, y = height / 2 - fillet;
  const std::int32_t edges = edges_for(kPi / 2 * fillet, edge, 3);
  const Point corners[] = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
  Chain chain;
  double from = 0;
  for (const Point& corner : corners) {
    const Chain turn = arc(corner, fillet, from, from + kPi / 2, edges);
    if (!chain.empty()) {
      line_to(chain, turn.front(), edge);
      chain.pop_back();
    }
    chain.insert(chain.end(), turn.begin(), turn.end());
    from += kPi / 2;
  }
  line_to(chain, chain.front(), edge);
  chain.pop_back();
  return chain;
}

// Bends a shape around the origin: its y axis becomes the direction `angle`, its origin goes to distance `radius`.
Chain bent(Chain chain, double radius, double angle) {
  for (Point& p : chain) {
    const double r = radius + p.y, phi = angle - p.x / radius;
    p = {r * std::cos(phi), r * std::sin(phi)};
  }
  return chain;
}

double middle_radius(const PipeOptions& o) {
  return (o.outer_radius + o.bore_radius) / 2;
}

}  // namespace

void require_valid(const PipeOptions& o) {
  const auto require = [](bool condition, const char* what) { require_option(condition, "pipe", what); };
  require(o.bore_radius > 0 && o.outer_radius > o.bore_radius, "0 < bore radius < outer radius is needed");
  require(o.edge > 0, "the edge length must be positive");
  require(o.channels >= 0 && o.channels <= 10000, "the number of channels must be 0 to 10000");
  require(o.channel_depth > 0 && o.channel_depth < o.outer_radius - o.bore_radius,
          "the channel depth must be positive and less than the thickness of the wall");
  require(o.fillet > 0 && 2 * o.fillet < std::min(o.channel_depth, o.channel_width),
          "the fillet must be positive and less than half the channel's depth and width");
  require(o.channels * o.channel_width < 2 * kPi * middle_radius(o),
          "the channels do not fit side by side; take fewer or narrower ones");
}

Pslg generate_pipe(const PipeOptions& o) {
  require_valid(o);
  const double middle = middle_radius(o);
  Pslg pslg;
  add_loop(pslg, circle({0, 0}, o.outer_radius, edges_for(2 * kPi * o.outer_radius, o.edge, 8)), 1);
  add_hole(pslg, circle({0, 0}, o.bore_radius, edges_for(2 * kPi * o.bore_radius, o.edge, 8)), {0, 0}, 2);
  if (o.channels == 0) return checked(std::move(pslg), "pipe");
  const Chain channel = rounded_rectangle(o.channel_width, o.channel_depth, o.fillet, o.edge);
  for (std::int32_t i = 0; i < o.channels; ++i) {
    const double angle = 2 * kPi * i / o.channels;
    add_hole(pslg, bent(channel, middle, angle), bent({{0, 0}}, middle, angle).front(), 3 + i);
  }
  return checked(std::move(pslg), "pipe");
}

void require_valid(const CylinderFlowOptions& o) {
  const auto require = [](bool condition, const char* what) { require_option(condition, "cylinder-flow", what); };
  require(o.radius > 0, "the radius must be positive");
  require(o.upstream > o.radius && o.downstream > o.radius && o.height > o.radius,
          "upstream, downstream and height must be larger than the radius");
  require(o.arc_edges >= 4 && o.arc_edges <= 10'000'000, "the arc must have 4 to 10000000 edges");
  require(o.edge > 0, "the edge length must be positive");
}

Pslg generate_cylinder_flow(const CylinderFlowOptions& o) {
  require_valid(o);
  Chain chain = arc({0, 0}, o.radius, kPi, 0, o.arc_edges);
  chain.front() = {-o.radius, 0};
  chain.back() = {o.radius, 0};
  std::vector<std::int32_t> markers(chain.size() - 1, 5);
  const auto side = [&](const Point& to, std::int32_t marker) {
    line_to(chain, to, o.edge);
    markers.resize(chain.size() - 1, marker);
  };
  side({o.downstream, 0}, 4);
  side({o.downstream, o.height}, 2);
  side({-o.upstream, o.height}, 3);
  side({-o.upstream, 0}, 1);
  side(chain.front(), 4);
  chain.pop_back();
  Pslg pslg;
  add_loop(pslg, chain, 0);
  for (std::size_t i = 0; i < markers.size(); ++i) pslg.segments[i].marker = markers[i];
  return checked(std::move(pslg), "cylinder-flow");
}

void require_valid(const FanOptions& o) {
  require_option(o.wedges >= 1 && o.wedges <= 10000, "fan", "the number of wedges must be 1 to 10000");
  require_option(o.angle > 0, "fan", "the angle must be positive");
  require_option(o.wedges * o.angle < (o.from_corner ? 90 : 360), "fan",
                 o.from_corner ? "the wedges must span less than 90 degrees at a corner"
                               : "the wedges must span less than 360 degrees");
}

Pslg generate_fan(const FanOptions& o) {
  require_valid(o);
  Pslg pslg;
  add_loop(pslg, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1);
  const Point apex = o.from_corner ? Point{0, 0} : Point{0.5, 0.5};
  const double reach = o.from_corner ? 0.9 : 0.45;
  const double wedge = o.angle * kPi / 180;
  const double from = o.from_corner ? (kPi / 2 - o.wedges * wedge) / 2 : 0;
  const std::int32_t center = o.from_corner ? 0 : 4;
  if (!o.from_corner) pslg.points.push_back(apex);
  for (const Point& tip : arc(apex, reach, from, from + o.wedges * wedge, o.wedges)) {
    pslg.segments.push_back({center, static_cast<std::int32_t>(pslg.points.size()), 2});
    pslg.points.push_back(tip);
  }
  return checked(std::move(pslg), "fan");
}

void require_valid(const CombOptions& o) {
  const auto require = [](bool condition, const char* what) { require_option(condition, "comb", what); };
  require(o.slits >= 1 && o.slits <= 10'000'000, "the number of slits must be 1 to 10000000");
  require(o.width > 0 && o.width < o.pitch, "the width of a slit must be positive and less than the pitch");
  require(o.depth > 0 && o.depth < 1, "the depth must be between 0 and 1, the height of the comb");
}

Pslg generate_comb(const CombOptions& o) {
  require_valid(o);
  const double length = (o.slits + 1) * o.pitch;
  Chain chain{{0, 0}, {length, 0}, {length, 1}};
  for (std::int32_t i = o.slits; i >= 1; --i) {
    const double left = i * o.pitch - o.width / 2, right = i * o.pitch + o.width / 2;
    chain.insert(chain.end(), {{right, 1}, {right, 1 - o.depth}, {left, 1 - o.depth}, {left, 1}});
  }
  chain.push_back({0, 1});
  Pslg pslg;
  add_loop(pslg, chain, 1);
  for (std::int32_t i = 0; i < o.slits; ++i)
    for (std::int32_t k = 0; k < 3; ++k) pslg.segments[3 + 4 * i + k].marker = 2;
  return checked(std::move(pslg), "comb");
}

void require_valid(const HolesOptions& o) {
  const auto require = [](bool condition, const char* what) { require_option(condition, "holes", what); };
  require(o.columns >= 1 && o.rows >= 1 && std::int64_t{o.columns} * o.rows <= 10'000'000,
          "columns and rows must be at least 1, with at most 10000000 holes");
  require(o.sides >= 3 && o.sides <= 100000, "a hole must have 3 to 100000 sides");
  require(o.radius > 0 && o.jitter >= 0 && o.radius + o.jitter < 0.5,
          "the radius must be positive and radius + jitter less than 0.5, half a cell");
}

Pslg generate_holes(const HolesOptions& o) {
  require_valid(o);
  SeededRandom random(o.seed);
  Pslg pslg;
  const double width = o.columns, height = o.rows;
  add_loop(pslg, {{0, 0}, {width, 0}, {width, height}, {0, height}}, 1);
  for (std::int32_t row = 0; row < o.rows; ++row)
    for (std::int32_t column = 0; column < o.columns; ++column) {
      const double x = column + 0.5 + random.uniform(-o.jitter, o.jitter);
      const double y = row + 0.5 + random.uniform(-o.jitter, o.jitter);
      add_hole(pslg, circle({x, y}, o.radius, o.sides), {x, y}, 2);
    }
  return checked(std::move(pslg), "holes");
}

void require_valid(const RectangleHoleOptions& o) {
  require_option(o.sides >= 3 && o.sides <= 10'000'000, "rectangle-hole", "the hole must have 3 to 10000000 sides");
  require_option(o.radius > 0 && o.radius < 0.5, "rectangle-hole", "the radius must be between 0 and 0.5");
}

Pslg generate_rectangle_hole(const RectangleHoleOptions& o) {
  require_valid(o);
  Pslg pslg;
  add_loop(pslg, {{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 1);
  add_hole(pslg, circle({1, 0.5}, o.radius, o.sides), {1, 0.5}, 2);
  return checked(std::move(pslg), "rectangle-hole");
}

}  // namespace driftmesh
