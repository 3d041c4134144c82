#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <type_traits>

#include "app/commands.hpp"
#include "pslg/generators.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::app {
namespace {

template <class Options>
struct Request {
  Options options;
  std::string output;
};

template <class Value>
void add_parameter(CLI::App& command, const std::string& name, Value& value, const char* what) {
  if constexpr (std::is_same_v<Value, bool>)
    command.add_flag("--" + name, value, what);
  else
    command.add_option("--" + name, value, what)
        ->capture_default_str()
        ->type_name(std::is_integral_v<Value> ? "N" : "NUMBER");
}

/// Adds the kind's subcommand.
template <class Options>
void add_kind(CLI::App& generate, const std::string& kind, const std::string& what, Pslg (*make)(const Options&)) {
  CLI::App* command = generate.add_subcommand(kind, what);
  command->footer("");  // not that of all kinds
  const auto request = std::make_shared<Request<Options>>();
  visit_parameters(request->options, [&](const char* name, auto& value, const char* meaning) {
    add_parameter(*command, name, value, meaning);
  });
  command->add_option("-o,--output", request->output, "The .poly file to write")->required()->type_name("FILE");
  command->callback([request, make] {
    const Pslg pslg = make(request->options);
    write_poly(pslg, request->output);
    std::cout << request->output << ": " << pslg.points.size() << " points, " << pslg.segments.size() << " segments, "
              << pslg.holes.size() << " holes\n";
  });
}

void add_models(CLI::App& generate) {
  add_kind(generate, "pipe", "Cross-section of a cooled pipe: a ring with channels in its wall", generate_pipe);
  add_kind(generate, "cylinder-flow", "Half of the channel around a cylinder at the origin", generate_cylinder_flow);
  add_kind(generate, "bay", "A bay with inlets, an estuary and islands, in metres", generate_bay);
}

void add_stress_tests(CLI::App& generate) {
  add_kind(generate, "fan", "A square with segments that leave one point at small angles", generate_fan);
  add_kind(generate, "comb", "A rectangle of height 1 with thin slits cut into it", generate_comb);
  add_kind(generate, "holes", "A plate with columns x rows holes in unit cells", generate_holes);
  add_kind(generate, "rectangle-hole", "A 2 x 1 rectangle with a regular polygon as a hole", generate_rectangle_hole);
  add_kind(generate, "random-polygon", "A random simple polygon: a labyrinth without loops", generate_random_polygon);
  add_kind(generate, "random-points", "Random points in a square, some joined by segments", generate_random_points);
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
