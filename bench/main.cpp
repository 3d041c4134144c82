// Measures the mesher on whole meshes and prints tables for docs/benchmarks.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "bench/models.hpp"
#include "bench/report.hpp"
#include "bench/suites.hpp"

namespace driftmesh::bench {
namespace {

struct CommandLine {
  std::vector<std::string> names;
  std::string data = DRIFTMESH_SOURCE_DIR "/../shared/data";
  std::string json;
  Options options;
};

void add_options(CLI::App& app, CommandLine& line) {
  std::vector<std::string> known;
  for (const auto& [name, suite] : suites()) known.push_back(name);
  app.add_option("suite", line.names, "What to measure; everything when absent")->check(CLI::IsMember(known));
  app.add_option("--data", line.data,
                 "Folder of pipe.poly, cylinder_flow.poly, chesapeake.poly; generated inputs stand in for missing ones")
      ->capture_default_str();
  app.add_option("--json", line.json, "Write every single run to this file");
  app.add_option("--repetitions", line.options.repetitions, "Runs of which the median counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--angle", line.options.degrees, "Bound on the angles, degrees")->capture_default_str();
  app.add_option("--cells", line.options.cells, "models and cut: area bound = area of the domain over this")
      ->capture_default_str();
  app.add_option("--parts", line.options.parts, "cut: about so many parts")->capture_default_str();
  app.add_option("--growth", line.options.growth, "growth: the same, one value a size")->capture_default_str();
}

std::vector<Measurement> measure(const CommandLine& line) {
  const std::vector<Model> models = load_models(line.data);
  std::vector<Measurement> all;
  for (const auto& [name, suite] : suites()) {
    if (!line.names.empty() && std::find(line.names.begin(), line.names.end(), name) == line.names.end()) continue;
    const std::vector<Measurement> measured = suite(models, line.options);
    all.insert(all.end(), measured.begin(), measured.end());
    std::cout << table_of(name, measured) << std::endl;
  }
  return all;
}

void write_json(const std::string& path, const std::vector<Measurement>& measurements) {
  std::ofstream file(path);
  file << to_json(measurements).dump(2) << '\n';
  if (!file.flush()) throw FileError(path, "cannot write");
}

int run(int argc, char** argv) {
  CLI::App app{"driftmesh_bench: how fast the mesher is, and how much memory it takes"};
  CommandLine line;
  add_options(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  std::cout << machine() << "\n\n";
  const std::vector<Measurement> measurements = measure(line);
  if (!line.json.empty()) write_json(line.json, measurements);
  return 0;
}

}  // namespace
}  // namespace driftmesh::bench

int main(int argc, char** argv) {
  try {
    return driftmesh::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "driftmesh_bench: " << error.what() << '\n';
    return 1;
  }
}
