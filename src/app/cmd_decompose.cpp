#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/cutting_options.hpp"
#include "app/decomposition_picture.hpp"
#include "app/output_files.hpp"
#include "app/sizing_options.hpp"
#include "base/error.hpp"
#include "base/standard_streams.hpp"
#include "base/stopwatch.hpp"
#include "cli/values.hpp"
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

std::string summary(const Decomposition& d, const DecompositionReport& report, bool predicts, double seconds) {
  double work = 0;
  for (const auto& s : d.subdomains) work += s.predicted;
  std::string text =
      fmt::format("Subdomains       {}, {} interfaces, made in {:.3f} s\n", d.size(), interfaces(d).size(), seconds);
  text += fmt::format("Work             {}largest {:.2f}, smallest {:.2f} of the mean\n",
                      predicts ? fmt::format("about {:.4g} triangles; ", work) : "by area; ", report.largest_load,
                      report.smallest_load);
  text += fmt::format("Separators       length {:.6g}, {:.3f} of the border's\n", report.separator_length,
                      report.separator_length / report.border_length);
  if (report.smallest_at != kNone) {
    const Point& p = d.points[static_cast<std::size_t>(report.smallest_at)];
    text += fmt::format("Smallest angle   {:.1f} degrees at ({:.10g}, {:.10g})\n", report.smallest_angle, p.x, p.y);
  }
  return text;
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
  if (!command.output.empty()) write_decomposition(d, pslg, command.output);
  if (!command.picture.empty())
    plot_decomposition(
        d, command.picture,
        fmt::format("{}: {} subdomains", std::filesystem::path(command.input).filename().string(), d.size()));
  if (!command.quiet) print(summary(d, report, bounds_size(command.options.bounds), seconds));
}

std::vector<cli::Option> triangle_options(DecomposeCommand& command) {
  constexpr const char* kGroup = "Triangles that the subdomains shall get equal numbers of (as for driftmesh mesh)";
  std::vector<cli::Option> all{{.name = "area",
                                .letter = 'a',
                                .value = "AREA",
                                .help = "No triangle is larger than this",
                                .group = kGroup,
                                .take = cli::into(command.area, cli::kPositive)}};
  std::ranges::move(sizing_options(command.sizing, kGroup), std::back_inserter(all));
  all.push_back({.kind = cli::Option::Kind::kFlag,
                 .name = "no-region-areas",
                 .help = "Ignore the area bounds of the input's regions",
                 .group = kGroup,
                 .take = cli::into(command.no_region_areas)});
  return all;
}

std::vector<cli::Option> decompose_options(DecomposeCommand& command) {
  std::vector<cli::Option> all{{.kind = cli::Option::Kind::kPositional,
                                .name = "input",
                                .value = "INPUT",
                                .help = "The domain: Triangle's .poly (its .node beside it), or .node",
                                .required = true,
                                .completes = cli::Option::Completes::kFile,
                                .take = cli::into(command.input)},
                               {.name = "subdomains",
                                .letter = 'n',
                                .value = "N",
                                .help = "How many",
                                .required = true,
                                .take = cli::into(command.options.subdomains, {1, kMaxSubdomains})},
                               {.name = "output",
                                .letter = 'o',
                                .value = "FILE",
                                .help = "Write the decomposition (text; docs/file-formats.md)",
                                .completes = cli::Option::Completes::kFile,
                                .take = cli::into(command.output)},
                               {.name = "plot",
                                .value = "FILE",
                                .help = "Picture in colors: .png, .svg or .pdf",
                                .completes = cli::Option::Completes::kFile,
                                .take = cli::into(command.picture)}};
  std::ranges::move(
      cutting_options({&command.options.min_angle, &command.options.skew, &command.options.seed}, "Options"),
      std::back_inserter(all));
  all.push_back({.kind = cli::Option::Kind::kFlag,
                 .name = "quiet",
                 .help = "Print nothing but errors",
                 .take = cli::into(command.quiet)});
  std::ranges::move(triangle_options(command), std::back_inserter(all));
  return all;
}

}  // namespace

cli::Command decompose_command() {
  const auto command = std::make_shared<DecomposeCommand>();
  return {.name = "decompose",
          .summary = "Cut a domain into subdomains of equal work",
          .options = decompose_options(*command),
          .examples = {"driftmesh decompose bay.poly -n 400 -o bay.decomposition --plot bay.png"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [command](cli::Call&) {
            run_decompose(*command);
            return 0;
          }};
}

}  // namespace driftmesh::app
