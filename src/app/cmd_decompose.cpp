#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/cutting_options.hpp"
#include "app/decomposition_picture.hpp"
#include "app/output_files.hpp"
#include "app/sizing_options.hpp"
#include "app/validators.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/decomposition_file.hpp"
#include "decompose/presplit.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/mesher.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/repair.hpp"

namespace driftmesh::app {
namespace {

struct DecomposeCommand {
  std::string input;
  std::string output;
  std::string picture;
  DecomposeOptions options;
  double area = 0;
  bool no_region_areas = false;
  SizingOptions sizing;
  bool quiet = false;
};

Pslg read_input(const DecomposeCommand& command) {
  Pslg pslg = read_poly(command.input);
  const RepairReport repairs = repair(pslg, command.input);
  if (!command.quiet) std::cerr << repairs.summary();
  return pslg;
}

Triangulation prepared(const Pslg& pslg) {
  Triangulation mesh = triangulate(pslg);
  prepare_corners(mesh);
  return mesh;
}

void print_summary(const Decomposition& d, const DecompositionReport& report, bool predicts, double seconds) {
  double work = 0;
  for (const auto& s : d.subdomains) work += s.predicted;
  fmt::print("Subdomains       {}, {} interfaces, made in {:.3f} s\n", d.size(), interfaces(d).size(), seconds);
  fmt::print("Work             {}largest {:.2f}, smallest {:.2f} of the mean\n",
             predicts ? fmt::format("about {:.4g} triangles; ", work) : "by area; ", report.largest_load,
             report.smallest_load);
  fmt::print("Separators       length {:.6g}, {:.3f} of the border's\n", report.separator_length,
             report.separator_length / report.border_length);
  if (report.smallest_at != kNone) {
    const Point& p = d.points[static_cast<std::size_t>(report.smallest_at)];
    fmt::print("Smallest angle   {:.1f} degrees at ({:.10g}, {:.10g})\n", report.smallest_angle, p.x, p.y);
  }
}

void run_decompose(DecomposeCommand& command) {
  check_sizing_options(command.sizing);
  check_outputs({}, command.picture, command.output, command.input);
  const Pslg pslg = read_input(command);
  const Triangulation mesh = prepared(pslg);
  command.options.bounds = bounds_of(pslg, {.max_area = command.area, .region_areas = !command.no_region_areas});
  const std::unique_ptr<SizeField> size = make_size_field(command.sizing);
  command.options.bounds.size = size.get();
  const Stopwatch watch;
  const Decomposition d = decompose(mesh, command.options);
  const double seconds = watch.seconds();
  const DecompositionReport report = check_decomposition(d);
  if (!report.valid()) throw Error("the decomposition is broken (please report this): " + report.problems[0]);
  if (!command.quiet) print_summary(d, report, bounds_size(command.options.bounds), seconds);
  if (!command.output.empty()) write_decomposition(d, pslg, command.output);
  if (!command.picture.empty())
    plot_decomposition(
        d, command.picture,
        fmt::format("{}: {} subdomains", std::filesystem::path(command.input).filename().string(), d.size()));
}

}  // namespace

void add_decompose(CLI::App& program) {
  const auto options = std::make_shared<DecomposeCommand>();
  CLI::App* command = program.add_subcommand("decompose", "Cut a domain into subdomains of equal work");
  command->add_option("input", options->input, "The domain: Triangle's .poly (its .node beside it), or .node")
      ->type_name("")
      ->required();
  command->add_option("-n,--subdomains", options->options.subdomains, "How many")
      ->check(CLI::Range(1, kMaxSubdomains).description(""))
      ->type_name("N")
      ->required();
  command->add_option("-o,--output", options->output, "Write the decomposition (text; docs/file-formats.md)")
      ->type_name("FILE");
  command->add_option("--plot", options->picture, "Picture in colours: .png, .svg or .pdf")->type_name("FILE");
  add_cutting_options(*command, {&options->options.min_angle, &options->options.skew, &options->options.seed},
                      "Options");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  constexpr const char* kGroup = "Triangles that the subdomains shall get equal numbers of (as for driftmesh mesh)";
  command->add_option("-a,--area", options->area, "No triangle is larger than this")
      ->check(positive())
      ->type_name("AREA")
      ->group(kGroup);
  add_sizing_options(*command, options->sizing, kGroup);
  command->add_flag("--no-region-areas", options->no_region_areas, "Ignore the area bounds of the input's regions")
      ->group(kGroup);
  command->footer(
      "Example: driftmesh decompose bay.poly -n 400 -o bay.decomposition --plot bay.png\n"
      "Exit code: 0 done, 1 error, 2 wrong usage.");
  command->callback([options] { run_decompose(*options); });
}

}  // namespace driftmesh::app
