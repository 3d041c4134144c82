#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/sizing_options.hpp"
#include "app/validators.hpp"
#include "base/error.hpp"
#include "io/mesh_file.hpp"
#include "mesh/digest.hpp"
#include "pslg/poly_file.hpp"
#include "pslg/repair.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

namespace driftmesh::app {
namespace {

constexpr int kRejected = 1;
constexpr int kUnreadable = 2;

struct CheckOptions {
  std::string mesh;
  std::string input;
  VerifyOptions verify;
  bool no_region_areas = false;
  SizingOptions sizing;
  bool quiet = false;
};

/// Every piece for itself: the digest of the whole is the sum.
std::vector<MeshPiece> read_and_digest(const CheckOptions& options) {
  std::vector<MeshPiece> pieces;
  if (is_in_pieces(options.mesh))
    pieces = read_pieces(options.mesh);
  else
    pieces.push_back(read_mesh(options.mesh));
  std::uint64_t digest = 0;
  for (const MeshPiece& piece : pieces) digest += mesh_digest(piece);
  if (!options.quiet) std::cout << fmt::format("digest         {:016x}\n", digest);
  return pieces;
}

std::optional<Pslg> read_and_repair(const CheckOptions& options) {
  if (options.input.empty()) return std::nullopt;
  Pslg input = read_poly(options.input);
  const RepairReport repairs = repair(input, options.input);
  if (!options.quiet) std::cout << repairs.summary();
  return input;
}

VerifyReport read_and_verify(const CheckOptions& options) {
  const std::vector<MeshPiece> pieces = read_and_digest(options);
  const std::optional<Pslg> input = read_and_repair(options);
  if (is_in_pieces(options.mesh)) return verify_pieces(pieces, input ? &*input : nullptr, options.verify);
  return input ? verify(pieces[0], *input, options.verify) : verify(pieces[0], options.verify);
}

int run_check(CheckOptions& options) {
  check_sizing_options(options.sizing);
  options.verify.region_areas = !options.no_region_areas;
  try {
    const std::unique_ptr<SizeField> size = make_size_field(options.sizing);
    options.verify.size = size.get();
    const VerifyReport report = read_and_verify(options);
    if (!options.quiet) std::cout << report_text(report, options.verify);
    std::cout << verdict_text(report, options.verify) << '\n';
    return report.accepted() ? 0 : kRejected;
  } catch (const Error& error) {
    std::cerr << "driftmesh: " << error.what() << '\n';
    return kUnreadable;
  }
}

}  // namespace

void add_check(CLI::App& program) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = program.add_subcommand("check", "Verify a mesh from its file, independent of how it was made");
  command->add_option("mesh", options->mesh, "The mesh: .vtu, .pvtu, .msh, or any file of Triangle's .node/.ele set")
      ->type_name("")
      ->required();
  command
      ->add_option("input", options->input,
                   "The .poly that the mesh was made from; with it, the mesh must cover its domain and hold its "
                   "segments, markers, points and regions")
      ->type_name("");
  constexpr const char* kGroup = "Bounds that the mesh must keep (as for driftmesh mesh)";
  command->add_option("-a,--area", options->verify.max_area, "No triangle is larger than this")
      ->check(positive())
      ->type_name("AREA")
      ->group(kGroup);
  command
      ->add_option("-q,--angle", options->verify.min_angle,
                   "No angle is smaller than this, in degrees, but for those that the input forces")
      ->check(CLI::Range(0.0, 60.0).description(""))
      ->type_name("DEGREES")
      ->group(kGroup);
  add_sizing_options(*command, options->sizing, kGroup);
  command->add_flag("--no-region-areas", options->no_region_areas, "Ignore the area bounds of the input's regions")
      ->group(kGroup);
  command->add_option("--list", options->verify.max_listed, "Findings to print of each kind")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Print the verdict alone");
  command->footer(
      "Angles below the bound are allowed where the input has them, and in wedges between input segments\n"
      "that meet at less than 60 degrees; the report lists them.\n"
      "Example:\n"
      "  driftmesh check bay.vtu bay.poly --angle 20 --area 5000\n"
      "Exit code: 0 accepted, 1 rejected, 2 a file could not be read, or wrong usage.");
  command->callback([options] {
    if (const int code = run_check(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace driftmesh::app
