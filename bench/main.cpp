// Measures the mesher on whole meshes and prints tables (bench/programs.py).
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/models.hpp"
#include "bench/report.hpp"
#include "bench/suites.hpp"
#include "cli/command_line.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::bench {
namespace {

struct CommandLine {
  std::vector<std::string> names;
  std::string data = DRIFTMESH_SOURCE_DIR "/../shared/data";
  std::string json;
  Options options;
};

cli::Command program(CommandLine& line, std::function<int(cli::Call&)> run) {
  std::vector<std::string> known;
  for (const auto& [name, suite] : suites()) known.push_back(name);
  Options& options = line.options;
  return {
      .name = "driftmesh_bench",
      .summary = "Measure the speed and the memory of the mesher",
      .options =
          {{.kind = cli::Option::Kind::kPositional,
            .name = "suite",
            .value = "SUITE",
            .help = "Suites to run",
            .standard = "everything",
            .repeats = true,
            .choices = known,
            .take = cli::into(line.names)},
           {.name = "data",
            .value = "FOLDER",
            .help = "Folder of pipe.poly, cylinder_flow.poly, chesapeake.poly; missing ones are replaced by "
                    "generated inputs",
            .standard = line.data,
            .take = cli::into(line.data)},
           {.name = "json", .value = "FILE", .help = "File for the results of all runs", .take = cli::into(line.json)},
           {.name = "repetitions",
            .value = "N",
            .help = "Number of runs; the median counts",
            .standard = std::to_string(options.repetitions),
            .take = cli::into(options.repetitions, cli::kPositive)},
           {.name = "angle", .value = "DEGREES", .help = "Bound on the angles", .take = cli::into(options.degrees)},
           {.name = "cells",
            .value = "N",
            .help = "models and cut: the area bound is the area of the domain divided by this",
            .take = cli::into(options.cells)},
           {.name = "parts",
            .value = "N",
            .help = "cut: approximate number of parts",
            .take = cli::into(options.parts)},
           {.name = "growth",
            .value = "N,N,...",
            .help = "growth: cells, one number for each size",
            .take = cli::into(options.growth)}},
      .run = std::move(run)};
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
  CommandLine line;
  return cli::run(program(line,
                          [&line](const cli::Call&) {
                            std::cout << machine() << "\n\n";
                            const std::vector<Measurement> measurements = measure(line);
                            if (!line.json.empty()) write_json(line.json, measurements);
                            return 0;
                          }),
                  argc, argv);
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
