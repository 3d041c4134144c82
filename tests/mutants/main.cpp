// driftmesh-mutants: edits valid files of every format at random, and reads them; or edits meshes, and checks them.

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <iostream>
#include <thread>

#include "base/standard_streams.hpp"
#include "base/stopwatch.hpp"
#include "cli/command_line.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "mutants/edits.hpp"
#include "mutants/judge.hpp"
#include "mutants/mesh_edits.hpp"
#include "mutants/mesh_judge.hpp"
#include "mutants/watched.hpp"
#include "oracles/mesh_faults.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace driftmesh;
using namespace driftmesh::mutants;

struct Request {
  std::string seeds = "1..1000", keep;
  std::uint64_t replay = 0;
  std::string sample;
  bool meshes = false;
  std::int64_t processes = std::max(1U, std::thread::hardware_concurrency());
};

/// "7..12"
std::pair<std::uint64_t, std::uint64_t> seed_range(const std::string& text) {
  const auto number = [&](std::string_view digits) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value == 0)
      throw Error("'" + text + "' is not a range of seeds; give two numbers, as in 1..1000");
    return value;
  };
  const std::size_t dots = std::min(text.find(".."), text.size());
  return {number(std::string_view(text).substr(0, dots)),
          number(std::string_view(text).substr(std::min(dots + 2, text.size())))};
}

/// Those whose names begin as the request says.
template <class Samples>
Samples chosen(Samples samples, const Request& request) {
  std::erase_if(samples, [&](const auto& sample) { return !sample.name.starts_with(request.sample); });
  if (samples.empty()) throw Error("no samples are called " + request.sample);
  return samples;
}

class FileProgram {
 public:
  explicit FileProgram(const Request& request)
      : request_(request), corpus_(chosen(make_corpus(folder_.path().string()), request)) {}

  /// The files themselves must be read.
  bool check_corpus() const {
    bool is_good = true;
    for (const Sample& sample : corpus_) {
      const Verdict verdict = read("sample", sample, sample.files);
      if (verdict.accepted && verdict.failure.empty()) continue;
      fmt::print("{}: {} {}\n", sample.name, verdict.failure, verdict.message);
      is_good = false;
    }
    return is_good;
  }

  bool replay(std::uint64_t seed) const {
    const Sample& sample = sample_of(corpus_, seed);
    const Mutant mutant = mutant_of(corpus_, seed);
    fmt::print("seed {}: {}\n", seed, sample.name);
    for (const std::string& edit : mutant.edits) fmt::print("  {}\n", edit);
    if (!request_.keep.empty()) write_files(mutant.files, request_.keep + "/seed-" + std::to_string(seed));
    std::fflush(stdout);
    const Verdict verdict = read("replay", sample, mutant.files);
    fmt::print("{}{}\n{}\n", verdict.accepted ? "accepted" : "refused", verdict.declared ? ", declared" : "",
               verdict.message);
    if (!verdict.failure.empty()) fmt::print("FAILED {}\n", verdict.failure);
    return verdict.failure.empty();
  }

  bool sweep() const {
    const auto [first, last] = seed_range(request_.seeds);
    const Stopwatch watch;
    const Totals totals = run_watched(
        first, last, static_cast<unsigned>(request_.processes), Limits(),
        [&](std::uint64_t seed, unsigned process) {
          const Sample& sample = sample_of(corpus_, seed);
          const Verdict verdict = read(std::to_string(process), sample, mutant_of(corpus_, seed).files);
          return Result{verdict.accepted, verdict.declared, verdict.failure};
        },
        [&](std::uint64_t seed, const std::string& failure) { report(seed, failure); });
    fmt::print("seeds {} to {}: {} failed\n", first, last, totals.failed);
    fmt::print("{} mutants of {} samples, {} accepted, {} refused (the second reader would take {} of them); ",
               totals.mutants, corpus_.size(), totals.accepted, totals.refused, totals.refused_though_declared);
    fmt::print("at most {:.1f} MB, {:.2f} s; {:.1f} s\n", static_cast<double>(totals.most_bytes) / 1e6, totals.longest,
               watch.seconds());
    return totals.failed == 0;
  }

 private:
  Verdict read(const std::string& name, const Sample& sample, const Files& files) const {
    const std::string folder = (folder_.path() / name).string();
    write_files(files, folder);
    return judge(sample, files, folder);
  }

  void report(std::uint64_t seed, const std::string& failure) const {
    fmt::print("seed {} ({}): {}\n", seed, seed == 0 ? "-" : sample_of(corpus_, seed).name, failure);
    std::fflush(stdout);
    if (!request_.keep.empty() && seed != 0)
      write_files(mutant_of(corpus_, seed).files, request_.keep + "/seed-" + std::to_string(seed));
  }

  Request request_;
  TemporaryFolder folder_;
  std::vector<Sample> corpus_;
};

class MeshProgram {
 public:
  explicit MeshProgram(const Request& request) : request_(request), samples_(chosen(make_mesh_samples(), request)) {}

  /// The meshes themselves must be accepted.
  bool check_corpus() const {
    bool is_good = true;
    for (const MeshSample& sample : samples_) {
      const MeshVerdict verdict = judge(sample, sample.mesh, 0, folder_of("sample"));
      if (verdict.accepted && verdict.failure.empty()) continue;
      fmt::print("{}: {} {}\n", sample.name, verdict.failure, verdict.fault);
      is_good = false;
    }
    return is_good;
  }

  bool replay(std::uint64_t seed) const {
    const MeshSample& sample = sample_of(samples_, seed);
    const MeshMutant mutant = mutant_of(samples_, seed);
    fmt::print("seed {}: {}\n", seed, sample.name);
    for (const std::string& edit : mutant.edits) fmt::print("  {}\n", edit);
    if (!request_.keep.empty()) keep(seed);
    std::fflush(stdout);
    const MeshVerdict verdict = judge(sample, mutant.mesh, seed, folder_of("replay"));
    fmt::print("{}; {}\n", verdict.accepted ? "accepted" : "rejected",
               verdict.fault.empty() ? "the mesh is right" : verdict.fault);
    if (!verdict.failure.empty()) fmt::print("FAILED {}\n", verdict.failure);
    return verdict.failure.empty();
  }

  bool sweep() const {
    const auto [first, last] = seed_range(request_.seeds);
    const Stopwatch watch;
    const Totals totals = run_watched(
        first, last, static_cast<unsigned>(request_.processes), Limits(),
        [&](std::uint64_t seed, unsigned process) {
          const MeshVerdict verdict = judge(sample_of(samples_, seed), mutant_of(samples_, seed).mesh, seed,
                                            folder_of(std::to_string(process)));
          return Result{verdict.accepted, verdict.fault.empty(), verdict.failure};
        },
        [&](std::uint64_t seed, const std::string& failure) {
          fmt::print("seed {} ({}): {}\n", seed, seed == 0 ? "-" : sample_of(samples_, seed).name, failure);
          std::fflush(stdout);
          if (!request_.keep.empty() && seed != 0) keep(seed);
        });
    fmt::print("seeds {} to {}: {} failed\n", first, last, totals.failed);
    fmt::print("{} mutants of {} meshes, {} accepted, {} rejected; at most {:.1f} MB, {:.2f} s; {:.1f} s\n",
               totals.mutants, samples_.size(), totals.accepted, totals.refused,
               static_cast<double>(totals.most_bytes) / 1e6, totals.longest, watch.seconds());
    return totals.failed == 0;
  }

 private:
  std::string folder_of(const std::string& name) const { return (folder_.path() / name).string(); }

  void keep(std::uint64_t seed) const {
    const std::filesystem::path folder = request_.keep + "/seed-" + std::to_string(seed);
    std::filesystem::create_directories(folder);
    write_poly(sample_of(samples_, seed).input, folder / "domain.poly");
    const Mesh mesh = mutant_of(samples_, seed).mesh;
    if (!oracles::fault_of(mesh).in_arrays) write_mesh(mesh, folder / "mesh.vtu");
  }

  Request request_;
  TemporaryFolder folder_;
  std::vector<MeshSample> samples_;
};

template <class Program>
int run(const Program& program, const Request& request) {
  if (request.replay != 0) return program.replay(request.replay) ? 0 : 1;
  const bool is_good = program.check_corpus();
  return program.sweep() && is_good ? 0 : 1;
}

cli::Command command(Request& request) {
  return {.name = "driftmesh-mutants",
          .summary = "Edit valid files of every format at random, read them, and check what comes of it",
          .options = {{.kind = cli::Option::Kind::kFlag,
                       .name = "meshes",
                       .help = "Edit meshes instead, and see whether checks reject those that are broken and no others",
                       .take = cli::into(request.meshes)},
                      {.name = "seeds",
                       .value = "FIRST..LAST",
                       .help = "The mutants to judge; print those that fail",
                       .standard = "1..1000",
                       .take = cli::into(request.seeds)},
                      {.name = "replay",
                       .value = "SEED",
                       .help = "Judge one mutant, in this process, and print what was edited and what came of it",
                       .take = cli::into(request.replay)},
                      {.name = "sample",
                       .value = "NAME",
                       .help = "Only edit samples whose names begin so",
                       .take = cli::into(request.sample)},
                      {.name = "keep",
                       .value = "FOLDER",
                       .help = "Write mutants that fail, or the one to replay, to FOLDER/seed-N",
                       .take = cli::into(request.keep)},
                      {.name = "processes",
                       .value = "N",
                       .help = "Processes to use",
                       .standard = "one for each core",
                       .take = cli::into(request.processes, {1, 1000})}},
          .exit_codes = "0 no mutant failed, 1 some did, 2 wrong usage",
          .run = [&request](const cli::Call&) {
            return request.meshes ? run(MeshProgram(request), request) : run(FileProgram(request), request);
          }};
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Request request;
    const int code = cli::run(command(request), argc, argv);
    flush_standard_output();
    return code;
  } catch (const std::exception& error) {
    std::cerr << "driftmesh-mutants: " << error.what() << '\n';
    return 2;
  }
}
