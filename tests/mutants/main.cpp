// driftmesh-mutants: edits valid files of every format at random, and reads them.

#include <fmt/format.h>

#include <charconv>
#include <iostream>
#include <thread>

#include "base/standard_streams.hpp"
#include "base/stopwatch.hpp"
#include "cli/command_line.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "mutants/edits.hpp"
#include "mutants/judge.hpp"
#include "mutants/watched.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace driftmesh;
using namespace driftmesh::mutants;

struct Request {
  std::string seeds = "1..1000", keep;
  std::uint64_t replay = 0;
  std::string sample;
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

class Program {
 public:
  explicit Program(const Request& request) : request_(request), corpus_(make_corpus(folder_.path().string())) {
    if (!request.sample.empty())
      std::erase_if(corpus_, [&](const Sample& sample) { return !sample.name.starts_with(request.sample); });
    if (corpus_.empty()) throw Error("no files are called " + request.sample);
  }

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

int run(const Request& request) {
  const Program program(request);
  if (request.replay != 0) return program.replay(request.replay) ? 0 : 1;
  const bool is_good = program.check_corpus();
  return program.sweep() && is_good ? 0 : 1;
}

cli::Command command(Request& request) {
  return {.name = "driftmesh-mutants",
          .summary = "Edit valid files of every format at random, read them, and check what comes of it",
          .options = {{.name = "seeds",
                       .value = "FIRST..LAST",
                       .help = "The mutants to read; print those that fail",
                       .standard = "1..1000",
                       .take = cli::into(request.seeds)},
                      {.name = "replay",
                       .value = "SEED",
                       .help = "Read one mutant, in this process, and print what was edited and what came of it",
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
          .run = [&request](const cli::Call&) { return run(request); }};
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
