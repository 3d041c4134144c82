#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/mesher.hpp"

namespace driftmesh::bench {

/// The runs of one mesher on one input under one bound.
struct Measurement {
  std::string suite;
  std::string model;
  std::string mesher;
  double area_bound = 0;  ///< 0: triangulated, not refined
  std::vector<MeshRun> runs;
};

/// Medians over the runs.
[[nodiscard]] double median_cdt(const Measurement& m);
[[nodiscard]] double median_refine(const Measurement& m);
/// Million triangles per second, refinement stage, median.
[[nodiscard]] double rate(const Measurement& m);
/// The largest memory peak of any run, divided by its triangles.
[[nodiscard]] double bytes_per_triangle(const Measurement& m);

/// One suite as a table in Markdown, with its heading.
[[nodiscard]] std::string table_of(const std::string& suite, const std::vector<Measurement>& measurements);

/// The machine: processor, cores, load, compiler.
[[nodiscard]] std::string machine();

/// All results, including every single run.
[[nodiscard]] nlohmann::json to_json(const std::vector<Measurement>& measurements);

}  // namespace driftmesh::bench
