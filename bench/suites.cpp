#include "bench/suites.hpp"

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "bench/cgal_mesher.hpp"
#include "bench/child_process.hpp"
#include "bench/driftmesh_mesher.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"

namespace driftmesh::bench {
namespace {

/// A size that is still bearable for the slow mesher: about a million triangles.
constexpr double kComparedCells = 0.645e6;

void announce(const std::string& what) {
  std::cerr << "measuring " << what << std::endl;
}

/// Measuring meshes that violate their bounds would be pointless. Angles may be smaller at acute corners of the input;
/// areas may not be larger anywhere.
void require_bounds(const MeshRun& run, const Bounds& bounds, const std::string& what) {
  constexpr double kRounding = 1e-9;
  if (bounds.area > 0 && run.largest_area > bounds.area * (1 + kRounding))
    throw Error(fmt::format("{}: a triangle of area {} violates the bound {}", what, run.largest_area, bounds.area));
}

/// Runs `mesh` repeatedly, each time in a child process.
Measurement repeat(Measurement m, const Bounds& bounds, int repetitions, const std::function<MeshRun()>& mesh) {
  announce(m.suite + ": " + m.mesher + " on " + m.model);
  m.area_bound = bounds.area;
  for (int i = 0; i < repetitions; ++i) {
    m.runs.push_back(in_child(mesh));
    require_bounds(m.runs.back(), bounds, m.mesher + " on " + m.model);
  }
  return m;
}

Measurement refine(const std::string& suite, const Model& model, const Mesher& mesher, const Bounds& bounds,
                   int repetitions) {
  return repeat({suite, model.name, mesher.name, 0, {}}, bounds, repetitions,
                [&] { return mesher.refine(model.pslg, bounds); });
}

std::vector<Measurement> on_every_model(const std::vector<Model>& models, const Options& options) {
  std::vector<Measurement> result;
  for (const Model& model : models)
    result.push_back(
        refine("models", model, kDriftmesh, {model.area / options.cells, options.degrees}, options.repetitions));
  return result;
}

std::vector<Measurement> against_cgal(const std::vector<Model>& models, const Options& options) {
  std::vector<Measurement> result;
  for (const Model& model : models) {
    const Bounds bounds{model.area / kComparedCells, options.degrees};
    result.push_back(refine("cgal", model, kDriftmesh, bounds, options.repetitions));
    result.push_back(refine("cgal", model, kCgal, bounds, options.repetitions));
  }
  return result;
}

std::vector<Measurement> cut_up(const std::vector<Model>& models, const Options& options) {
  std::vector<Measurement> result;
  for (const Model& model : models) {
    const Bounds bounds{model.area / options.cells, options.degrees};
    const std::vector<Pslg> parts = parts_of(model.pslg, model.area, options.degrees, options.parts);
    const std::string name = fmt::format("{}, {} parts", model.name, parts.size());
    result.push_back(repeat({"cut", name, kDriftmesh.name, 0, {}}, bounds, options.repetitions,
                            [&] { return refine_parts(parts, bounds); }));
  }
  return result;
}

std::vector<Measurement> growth(const std::vector<Model>& models, const Options& options) {
  std::vector<Measurement> result;
  for (const double cells : options.growth)
    result.push_back(refine("growth", models.front(), kDriftmesh, {models.front().area / cells, options.degrees},
                            options.repetitions));
  return result;
}

std::vector<Measurement> cdt(const std::vector<Model>& /*models*/, const Options& options) {
  const Model model{"1,000,000 random points, 100,000 segments",
                    generate_random_points({.points = 1'000'000, .segments = 100'000}), 1};
  std::vector<Measurement> result;
  for (const Mesher* mesher : {&kDriftmesh, &kCgal})
    result.push_back(repeat({"cdt", model.name, mesher->name, 0, {}}, {}, options.repetitions,
                            [&] { return mesher->triangulate(model.pslg); }));
  return result;
}

}  // namespace

const std::map<std::string, Suite>& suites() {
  static const std::map<std::string, Suite> all{
      {"cdt", cdt}, {"cgal", against_cgal}, {"cut", cut_up}, {"growth", growth}, {"models", on_every_model}};
  return all;
}

}  // namespace driftmesh::bench
