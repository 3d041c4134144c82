#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <type_traits>

#include "app/commands.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "pslg/generators.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::app {
namespace {

template <class Options>
struct Asked {
  Options options;
  std::string output;
};

template <class Value>
cli::Option parameter(const std::string& name, Value& value, const char* what) {
  if constexpr (std::is_same_v<Value, bool>)
    return {.kind = cli::Option::Kind::kFlag, .name = name, .help = what, .take = cli::into(value)};
  else
    return {.name = name,
            .value = std::is_integral_v<Value> ? "N" : "NUMBER",
            .help = what,
            .standard = fmt::format("{}", value),
            .take = cli::into(value)};
}

/// A file without an extension may have any name, and so may a device or a pipe.
void require_poly(const std::string& output) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string extension = fs::path(output).extension().string();
  if (extension.empty() || extension == ".poly" || fs::is_other(fs::status(output, ignored))) return;
  throw InputError({output}, "has the extension '" + extension + "'",
                   "a generated domain is written as .poly alone; driftmesh mesh writes meshes, and driftmesh plot "
                   "pictures");
}

void report(const Pslg& pslg, const std::string& file) {
  print(fmt::format("{}: {} points, {} segments, {} holes\n", file, pslg.points.size(), pslg.segments.size(),
                    pslg.holes.size()));
}

/// The command for one kind of input.
template <class Options>
cli::Command kind(const std::string& name, const std::string& what, Pslg (*make)(const Options&)) {
  const auto request = std::make_shared<Asked<Options>>();
  cli::Command command{.name = name, .summary = what};
  visit_parameters(request->options, [&](const char* parameter_name, auto& value, const char* meaning) {
    command.options.push_back(parameter(parameter_name, value, meaning));
  });
  command.options.push_back({.name = "output",
                             .letter = 'o',
                             .value = "FILE",
                             .help = "The .poly file to write; - is standard output",
                             .required = true,
                             .completes = cli::Option::Completes::kFile,
                             .take = cli::into(request->output)});
  command.run = [request, make](cli::Call&) {
    require_poly(request->output);
    const Pslg pslg = make(request->options);
    write_poly(pslg, request->output);
    report(pslg, request->output);
    return 0;
  };
  return command;
}

}  // namespace

cli::Command generate_command() {
  return {.name = "generate",
          .summary = "Generate an input: a model with parameters, or a stress test",
          .commands =
              {kind("pipe", "Cross-section of a cooled pipe: a ring with channels in its wall", generate_pipe),
               kind("cylinder-flow", "Half of the channel around a cylinder at the origin", generate_cylinder_flow),
               kind("bay", "A bay with inlets, an estuary and islands, in meters", generate_bay),
               kind("fan", "A square with segments that meet in one point at small angles", generate_fan),
               kind("comb", "A rectangle of height 1 with thin slits cut into it", generate_comb),
               kind("holes", "A plate with a grid of holes, one in each unit cell", generate_holes),
               kind("rectangle-hole", "A 2 x 1 rectangle with a regular polygon as a hole", generate_rectangle_hole),
               kind("random-polygon", "A random simple polygon: a labyrinth without loops", generate_random_polygon),
               kind("random-points", "Random points in a square, some joined by segments", generate_random_points)},
          .notes = "Parameters of a kind: driftmesh generate KIND --help",
          .examples = {"driftmesh generate bay --seed 7 -o bay.poly"},
          .exit_codes = "0 done, 1 error, 2 wrong usage"};
}

}  // namespace driftmesh::app
