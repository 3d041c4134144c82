#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <type_traits>

#include "app/commands.hpp"
#include "pslg/generate.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::app {
namespace {

template <class Options>
struct Request {
  Options options;
  std::string output;
};

/// Adds the kind's subcommand. `describe(command, options)` adds its own options.
template <class Options, class Describe>
void add_kind(CLI::App& generate, const std::string& kind, const std::string& what, Pslg (*make)(const Options&),
              Describe describe) {
  CLI::App* command = generate.add_subcommand(kind, what);
  command->footer("");  // not that of all kinds
  const auto request = std::make_shared<Request<Options>>();
  describe(*command, request->options);
  command->add_option("-o,--output", request->output, "The .poly file to write")->required()->type_name("FILE");
  command->callback([request, make] {
    const Pslg pslg = make(request->options);
    write_poly(pslg, request->output);
    std::cout << request->output << ": " << pslg.points.size() << " points, " << pslg.segments.size() << " segments, "
              << pslg.holes.size() << " holes\n";
  });
}

template <class Value>
void option(CLI::App& command, const char* name, Value& value, const char* what) {
  command.add_option(name, value, what)->capture_default_str()->type_name(std::is_integral_v<Value> ? "N" : "NUMBER");
}

void add_models(CLI::App& generate) {
  add_kind<PipeOptions>(generate, "pipe", "Cross-section of a cooled pipe: a ring with channels in its wall",
                        generate_pipe, [](CLI::App& command, PipeOptions& o) {
                          option(command, "--outer-radius", o.outer_radius, "Radius of the outside");
                          option(command, "--bore-radius", o.bore_radius, "Radius of the bore");
                          option(command, "--channels", o.channels, "Number of channels");
                          option(command, "--channel-depth", o.channel_depth, "Depth of a channel, along the radius");
                          option(command, "--channel-width", o.channel_width, "Width of a channel, along the circle");
                          option(command, "--fillet", o.fillet, "Radius of the rounded corners of a channel");
                          option(command, "--edge", o.edge, "Longest edge of the boundary");
                        });
  add_kind<CylinderFlowOptions>(
      generate, "cylinder-flow", "Half of the channel around a cylinder at the origin", generate_cylinder_flow,
      [](CLI::App& command, CylinderFlowOptions& o) {
        option(command, "--radius", o.radius, "Radius of the cylinder");
        option(command, "--upstream", o.upstream, "Distance from the cylinder's center to the inflow");
        option(command, "--downstream", o.downstream, "Distance from the cylinder's center to the outflow");
        option(command, "--height", o.height, "Height of the half channel");
        option(command, "--arc-edges", o.arc_edges, "Edges of the half circle");
        option(command, "--edge", o.edge, "Longest edge of the other sides");
      });
  add_kind<BayOptions>(generate, "bay", "A bay with inlets, an estuary and islands, in metres", generate_bay,
                       [](CLI::App& command, BayOptions& o) {
                         option(command, "--width", o.width, "Width of the region, in metres");
                         option(command, "--height", o.height, "Height of the region, in metres");
                         option(command, "--resolution", o.resolution,
                                "About the distance of the coastline's points, in metres");
                         option(command, "--roughness", o.roughness, "0: smooth coast, 1: very ragged");
                         option(command, "--seed", o.seed, "Another seed makes another bay");
                       });
}

void add_stress_tests(CLI::App& generate) {
  add_kind<FanOptions>(generate, "fan", "A square with segments that leave one point at small angles", generate_fan,
                       [](CLI::App& command, FanOptions& o) {
                         option(command, "--wedges", o.wedges, "Number of angles");
                         option(command, "--angle", o.angle, "Each angle, in degrees");
                         command.add_flag("--corner", o.from_corner, "From a corner and not from the center");
                       });
  add_kind<CombOptions>(generate, "comb", "A rectangle of height 1 with thin slits cut into it", generate_comb,
                        [](CLI::App& command, CombOptions& o) {
                          option(command, "--slits", o.slits, "Number of slits");
                          option(command, "--pitch", o.pitch, "Distance of the slits");
                          option(command, "--width", o.width, "Width of a slit");
                          option(command, "--depth", o.depth, "Depth of a slit, below 1");
                        });
  add_kind<HolesOptions>(generate, "holes", "A plate with columns x rows holes in unit cells", generate_holes,
                         [](CLI::App& command, HolesOptions& o) {
                           option(command, "--columns", o.columns, "Holes in a row");
                           option(command, "--rows", o.rows, "Rows of holes");
                           option(command, "--sides", o.sides, "Sides of a hole");
                           option(command, "--radius", o.radius, "Radius of a hole, below 0.5");
                           option(command, "--jitter", o.jitter, "Random displacement of a hole in each axis");
                           option(command, "--seed", o.seed, "Seed of the displacements");
                         });
  add_kind<RectangleHoleOptions>(generate, "rectangle-hole", "A 2 x 1 rectangle with a regular polygon as a hole",
                                 generate_rectangle_hole, [](CLI::App& command, RectangleHoleOptions& o) {
                                   option(command, "--sides", o.sides, "Sides of the hole");
                                   option(command, "--radius", o.radius, "Radius of the hole, below 0.5");
                                 });
  add_kind<RandomPolygonOptions>(generate, "random-polygon", "A random simple polygon: a labyrinth without loops",
                                 generate_random_polygon, [](CLI::App& command, RandomPolygonOptions& o) {
                                   option(command, "--vertices", o.vertices, "Number of vertices");
                                   option(command, "--jitter", o.jitter,
                                          "Largest displacement of a corner, below 0.5; edges have length 1");
                                   option(command, "--seed", o.seed, "Another seed makes another polygon");
                                 });
  add_kind<RandomPointsOptions>(
      generate, "random-points", "Random points in a square, some joined by segments", generate_random_points,
      [](CLI::App& command, RandomPointsOptions& o) {
        option(command, "--points", o.points, "Number of points, besides the corners of the square");
        option(command, "--segments", o.segments, "Number of segments, at most a quarter of the points");
        option(command, "--seed", o.seed, "Another seed makes other points");
      });
}

}  // namespace

void add_generate(CLI::App& program) {
  CLI::App* generate = program.add_subcommand("generate", "Make an input: a model with parameters, or a stress test");
  generate->require_subcommand(1);
  generate->footer(
      "Options of a kind: driftmesh generate KIND --help\n"
      "Example:\n"
      "  driftmesh generate bay --seed 7 -o bay.poly\n"
      "Exit code: 0 done, 1 error, 2 wrong usage.");
  add_models(*generate);
  add_stress_tests(*generate);
}

}  // namespace driftmesh::app
