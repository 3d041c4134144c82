#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "mutants/edits.hpp"
#include "mutants/judge.hpp"
#include "mutants/mesh_edits.hpp"
#include "mutants/mesh_judge.hpp"
#include "mutants/watched.hpp"
#include "oracles/mesh_faults.hpp"
#include "temporary_folder.hpp"

// That driftmesh-mutants sees what it is to find.

using namespace driftmesh;
using namespace driftmesh::mutants;

namespace {

/// What was reported, by whichever process: the lines of a file.
std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// A reader that does something wrong with every seed but 1.
Result misbehave(std::uint64_t seed) {
  if (seed == 2) return {false, false, "wrong mesh"};
  if (seed == 3) throw std::runtime_error("no Error");
  if (seed == 4) std::_Exit(3);
  if (seed == 5) ::raise(SIGKILL);
  if (seed == 6) ::pause();
  if (seed == 7) return {std::vector<char>(60'000'000).back() == 'x', false, ""};
  if (seed == 8) throw std::bad_alloc();
  return {true, true, ""};
}

/// The first two words of its name: "vtu-full" of "vtu-full-zlib-base64".
std::string content_of(const Sample& sample) {
  return sample.name.substr(0, sample.name.find('-', sample.name.find('-') + 1));
}

}  // namespace

TEST_CASE("crashes, hangs, foreign exceptions and large allocations are failures, and the others go on") {
  const TemporaryFolder folder;
  const std::filesystem::path log = folder.path() / "log";
  const Totals totals = run_watched(
      1, 9, 1, {.seconds = 1, .bytes = 50'000'000}, [](std::uint64_t seed, unsigned) { return misbehave(seed); },
      [&](std::uint64_t seed, const std::string& failure) {
        std::ofstream(log, std::ios::app) << seed << " " << failure << "\n";
      });
  CHECK(totals.mutants == 9);
  CHECK(totals.accepted == 2);
  CHECK(totals.failed == 7);
  CHECK(totals.refused == 0);
  CHECK(lines_of(log) == std::vector<std::string>{"2 wrong mesh",
                                                  "3 ends with an exception that is no driftmesh::Error: no Error",
                                                  "4 crashes with exit code 3", "5 crashes with signal 9", "6 hangs",
                                                  "7 takes too much memory", "8 takes too much memory"});
}

TEST_CASE("a mutant depends on its seed alone, and is seldom the sample") {
  const TemporaryFolder folder;
  const std::vector<Sample> corpus = make_corpus(folder.path().string());
  std::size_t unchanged = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Mutant mutant = mutant_of(corpus, seed);
    CHECK(mutant.files == mutant_of(corpus, seed).files);
    CHECK(!mutant.edits.empty());
    unchanged += mutant.files == sample_of(corpus, seed).files;
  }
  CHECK(unchanged < 10);
}

TEST_CASE("each sample is accepted, and another mesh than declared is a failure") {
  const TemporaryFolder folder;
  const std::vector<Sample> corpus = make_corpus(folder.path().string());
  const std::string place = (folder.path() / "files").string();
  for (const Sample& sample : corpus) {
    CAPTURE(sample.name);
    write_files(sample.files, place);
    const Verdict verdict = judge(sample, sample.files, place);
    CHECK(verdict.accepted);
    CHECK(verdict.failure == "");
    // As if the reader had read another sample, which for some is the same mesh in another form.
    for (const Sample& other : corpus) {
      if (other.reading != sample.reading || other.main != sample.main || other.files == sample.files) continue;
      CAPTURE(other.name);
      CHECK((judge(sample, other.files, place).failure == "") == (content_of(other) == content_of(sample)));
    }
  }
}

TEST_CASE("edits of meshes depend on the seed alone, are of every kind, and make good and broken meshes") {
  const TemporaryFolder folder;
  const std::vector<MeshSample> samples = make_mesh_samples();
  std::map<std::string, std::size_t> good, broken;  // after a single edit, by its kind
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    const MeshMutant mutant = mutant_of(samples, seed);
    CHECK(!mutant.edits.empty());
    CHECK(mutant.edits == mutant_of(samples, seed).edits);
    const MeshSample& sample = sample_of(samples, seed);
    if (mutant.edits.size() > 1 || sample.mesh.triangles.size() > 60) continue;
    const bool is_good = oracles::fault_of(mutant.mesh, sample.input, sample.mesh).what.empty();
    ++(is_good ? good : broken)[mutant.edits[0].substr(0, mutant.edits[0].find(':'))];
  }
  for (const std::string& kind : mesh_edit_kinds()) {
    CAPTURE(kind);
    CHECK(good[kind] + broken[kind] > 5);
  }
  for (const std::string kind : {"permute", "turn a subsegment", "negative zeros", "add an unused point"}) {
    CAPTURE(kind);
    CHECK(good[kind] > 5);
    CHECK(broken[kind] == 0);
  }
  for (const std::string kind : {"double a triangle", "turn a triangle", "remove a triangle"}) {
    CAPTURE(kind);
    CHECK(good[kind] == 0);
  }
  for (const std::string kind : {"along subsegments", "flip an edge", "a little", "change a marker"}) {
    CAPTURE(kind);
    CHECK(good[kind] > 0);
    CHECK(broken[kind] > 0);
  }
}

TEST_CASE("each mesh is accepted, and a check that says something else than the oracle is a failure") {
  const TemporaryFolder folder;
  for (MeshSample sample : make_mesh_samples()) {
    CAPTURE(sample.name);
    const Mesh right = sample.mesh;
    const MeshVerdict verdict = judge(sample, right, 1, folder.path().string());
    CHECK(verdict.accepted);
    CHECK(verdict.fault == "");
    CHECK(verdict.failure == "");
    // As if the checks did not know the domain.
    sample.mesh.points.clear();
    sample.mesh.triangles.clear();
    CHECK(judge(sample, right, 1, folder.path().string()).failure.find("accepts a mesh, but") != std::string::npos);
  }
}
