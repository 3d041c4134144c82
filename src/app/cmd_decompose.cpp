#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/repair_view.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/staged_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decomposition_file.hpp"
#include "decompose/presplit.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/files.hpp"
#include "job/make.hpp"
#include "picture/plot_decomposition.hpp"

namespace driftmesh::app {
namespace {

struct DecomposeCommand {
  GivenKeys given;
  std::string output;
  std::string picture;
  bool quiet = false;
};

job::Request request_of(const GivenKeys& given) {
  job::Request request;
  given.apply(request);
  if (request.input.file.empty() && request.input.contour.empty()) throw cli::UsageError("INPUT is missing");
  if (request.decomposition.subdomains == 0)
    throw job::KeyError("decomposition.subdomains", "is 0", "it must be at least 1");
  job::check(request, job::kSubdomains);
  job::check_given(request, given.names());
  return request;
}

std::string summary(const Decomposition& d, const DecompositionReport& report, double seconds) {
  double work = 0;
  for (const auto& s : d.subdomains) work += s.predicted;
  std::string text =
      fmt::format("Subdomains       {}, {} interfaces, made in {:.3f} s\n", d.size(), interfaces(d).size(), seconds);
  text += fmt::format("Work             about {:.4g} triangles; largest {:.2f}, smallest {:.2f} of the mean\n", work,
                      report.largest_load, report.smallest_load);
  text += fmt::format("Separators       length {:.6g}, {:.3f} of the border's\n", report.separator_length,
                      report.separator_length / report.border_length);
  if (report.smallest_at != kNoPoint) {
    const Point& p = d.points[report.smallest_at];
    text += fmt::format("Smallest angle   {:.1f} degrees at ({:.10g}, {:.10g})\n", report.smallest_angle, p.x, p.y);
  }
  return text;
}

void register_files(const DecomposeCommand& command, const job::Request& request) {
  FileRegistry files;
  job::register_reads(request, job::kDecompose, files);
  register_output(files, command.output, "--output");
  register_picture(files, command.picture, "--plot");
}

void run_decompose(const DecomposeCommand& command) {
  const job::Request request = request_of(command.given);
  register_files(command, request);
  RepairView view(command.quiet);
  const auto [domain, d, seconds] = job::make_cut({request, job::kDecompose, job::Given{}}, 1, view);
  const DecompositionReport report = check_decomposition(d);
  if (!report.valid()) throw Error("the decomposition is broken (please report this): " + report.problems[0]);
  StagedFiles files;
  if (!command.output.empty()) write_decomposition(d, domain.pslg, command.output);
  if (!command.picture.empty())
    plot_decomposition(d, command.picture,
                       fmt::format("{}: {} subdomains",
                                   std::filesystem::path(job::input_name(request)).filename().string(), d.size()));
  files.commit();
  if (!command.quiet) print(summary(d, report, seconds));
}

std::vector<cli::Option> decompose_options(DecomposeCommand& command) {
  std::vector<cli::Option> all = key_options(job::kDecompose, command.given);
  for (cli::Option& option : all) option.required = option.name == "subdomains";
  std::ranges::move(std::vector<cli::Option>{{.name = "output",
                                              .letter = 'o',
                                              .value = "FILE",
                                              .help = "File for the decomposition (text; see docs/file-formats.md)",
                                              .completes = cli::Option::Completes::kFile,
                                              .take = cli::into(command.output)},
                                             {.name = "plot",
                                              .value = "FILE",
                                              .help = "Picture of the subdomains: .png, .svg or .pdf",
                                              .completes = cli::Option::Completes::kFile,
                                              .take = cli::into(command.picture)},
                                             {.kind = cli::Option::Kind::kFlag,
                                              .name = "quiet",
                                              .help = "Print only errors",
                                              .take = cli::into(command.quiet)}},
                    std::back_inserter(all));
  return all;
}

}  // namespace

cli::Command decompose_command() {
  const auto command = std::make_shared<DecomposeCommand>();
  return {
      .name = "decompose",
      .summary = "Cut a domain into subdomains of equal work",
      .options = decompose_options(*command),
      .notes = "Subdomains get equal shares of the triangles that the bounds require, or of the area without bounds.",
      .examples = {"driftmesh decompose bay.poly -n 400 -o bay.decomposition --plot bay.png"},
      .exit_codes = "0 done, 1 error, 2 wrong usage",
      .run = [command](cli::Call&) {
        in_words_of_options(command->given, {}, [&] { run_decompose(*command); });
        return 0;
      }};
}

}  // namespace driftmesh::app
