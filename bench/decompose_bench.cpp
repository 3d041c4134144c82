// Quality of decompositions: time, angles, balance, interfaces, and length of separators, absolute and relative to that
// of the border and to that of compact subdomains.
//   driftmesh_bench_decompose [--separator-angle A] [-n N]... [FILE.poly ...]
//   (default: -n 400 -n 4000, and generated inputs)

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "pslg/poly_file.hpp"

using namespace driftmesh;

namespace {

/// The median of five.
double time_decompose(const Triangulation& mesh, const DecomposeOptions& options, Decomposition& result) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const Stopwatch watch;
    result = decompose(mesh, options);
    times.push_back(watch.seconds());
  }
  std::sort(times.begin(), times.end());
  return times[2];
}

void print_header() {
  std::printf("%-20s %6s %8s %6s %8s %8s %10s %10s %10s %9s\n", "input", "N", "seconds", "angle", "max/mean",
              "min/mean", "length", "/border", "/expected", "interfaces");
}

void print_row(const std::string& name, const Triangulation& mesh, const DecomposeOptions& options) {
  Decomposition d;
  const double seconds = time_decompose(mesh, options, d);
  const DecompositionReport r = check_decomposition(d);
  const double expected = 2.06 * std::sqrt(r.area * options.subdomains) - r.border_length / 2;
  std::printf("%-20s %6d %8.4f %6.2f %8.3f %8.3f %10.6g %10.4f %10.4f %9zu %s\n", name.c_str(), options.subdomains,
              seconds, r.smallest_angle, r.largest_load, r.smallest_load, r.separator_length,
              r.separator_length / r.border_length, r.separator_length / expected, interfaces(d).size(),
              r.valid() ? "valid" : r.problems[0].c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> counts;
  std::vector<std::string> files;
  DecomposeOptions options;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "-n") == 0 && i + 1 < argc)
      counts.push_back(std::atoi(argv[++i]));
    else if (std::strcmp(argv[i], "--separator-angle") == 0 && i + 1 < argc)
      options.min_angle = std::atof(argv[++i]);
    else
      files.emplace_back(argv[i]);
  if (counts.empty()) counts = {400, 4000};
  print_header();
  std::vector<std::pair<std::string, Pslg>> inputs;
  try {
    for (const std::string& file : files) inputs.emplace_back(file.substr(file.find_last_of('/') + 1), read_poly(file));
    if (files.empty())
      inputs = {{"generated pipe", generate_pipe({})},
                {"generated flow", generate_cylinder_flow({})},
                {"generated bay", generate_bay({})}};
    for (auto& [name, pslg] : inputs) {
      repair(pslg, name);
      Triangulation mesh = triangulate(pslg);
      prepare_corners(mesh);
      for (const int n : counts) {
        options.subdomains = n;
        print_row(name, mesh, options);
      }
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
