#include "sim/journey.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "distributed/parts_file.hpp"
#include "property/cases.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::sim;

namespace {

constexpr SubdomainId kForgotten{1};

/// A checkpoint on a disk.
class OnDisk {
 public:
  explicit OnDisk(const std::string& content) { std::ofstream(path_, std::ios::binary) << content; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string content() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  TemporaryFolder folder_;
  std::string path_ = (folder_.path() / kCheckpoint).string();
};

/// The newer checkpoint with a subdomain of the older one: what a run would have that kept all but this one.
std::string with_forgotten(const std::string& older, const std::string& newer) {
  const OnDisk from(older), to(newer);
  const PartsFile old_file(from.path(), kCheckpointFile), new_file(to.path(), kCheckpointFile);
  const auto part = [&](SubdomainId s) { return (s == kForgotten ? old_file : new_file).part(s); };
  std::map<SubdomainId, std::uint64_t> sizes;
  for (const SubdomainId s : first_ids<SubdomainId>(new_file.ends().size())) sizes[s] = part(s).size();
  const std::map<std::string, Bytes> heads{{"settings", new_file.head("settings")},
                                           {kCheckpointFile.head, new_file.head(kCheckpointFile.head)}};
  OneRank one;
  write_parts(to.path(), kCheckpointFile, heads, sizes.size(), sizes, part, one);
  return to.content();
}

// A broken rule must be found within this number of seeds.
void must_be_caught(Journeys journeys, std::uint64_t seeds, const std::string& as) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::string problem = journeys.travel(JourneyPlan::from_seed(seed));
    if (problem.find(as) == std::string::npos) continue;
    MESSAGE("caught at seed ", seed, ": ", problem);
    return;
  }
  FAIL("not caught within ", seeds, " seeds");
}

}  // namespace

TEST_CASE("runs that are killed, hung and slowed down end with the mesh of one that nothing befalls") {
  Journeys journeys;
  const auto seeds = static_cast<std::uint64_t>(testing::case_count(60));
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    CAPTURE(JourneyPlan::from_seed(seed).describe());
    REQUIRE(journeys.travel(JourneyPlan::from_seed(seed)) == "");
  }
  JourneyCounts counts = journeys.counts();
  MESSAGE(words_of(counts));
  if (seeds < 60) return;  // what so few meet is left to chance
  CHECK(counts.in_rounds > counts.journeys / 2);
  CHECK(counts.in_rounds < counts.journeys);
  CHECK(counts.resumed > counts.journeys / 4);
  CHECK(counts.anew > counts.journeys);
  CHECK(counts.saves > counts.lives);
  CHECK(counts.refused > 0);
  CHECK(counts.given_up > counts.journeys / 20);
  for (const Fault::Kind kind :
       {Fault::Kind::kKill, Fault::Kind::kKillAtWrite, Fault::Kind::kHang, Fault::Kind::kTerminate, Fault::Kind::kPause,
        Fault::Kind::kSlow, Fault::Kind::kLate, Fault::Kind::kFull}) {
    CAPTURE(name_of(kind));
    CHECK(counts.faults[kind] > counts.journeys / 20);
  }
}

TEST_CASE("a journey is repeated exactly by its seed") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Journeys one, two;
    CHECK(one.travel(JourneyPlan::from_seed(seed)) == two.travel(JourneyPlan::from_seed(seed)));
    CHECK(words_of(one.counts()) == words_of(two.counts()));
    CHECK(one.counts().oldest == two.counts().oldest);
  }
}

TEST_CASE("mutation: a checkpoint appears before it is complete") {
  must_be_caught(Journeys(Sabotage::kEarlyRename), 200, "checkpoint");
}

TEST_CASE("mutation: a subdomain is not gone on with from where it was") {
  auto older = std::make_shared<std::string>();
  must_be_caught(Journeys(Sabotage::kNone,
                          [older](Files& files) {
                            const auto kept = files.find(kCheckpoint);
                            if (kept == files.end()) return older->clear();
                            const std::string now = kept->second;
                            if (!older->empty()) kept->second = with_forgotten(*older, now);
                            *older = now;
                          }),
                 200, "triangles were kept");
}
