#include "sim/life.hpp"

#include <algorithm>
#include <csignal>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "balancer/policies/policy_factory.hpp"
#include "job/checkpoint_file.hpp"
#include "job/make.hpp"
#include "job/on_ranks.hpp"
#include "job/rounds_on_ranks.hpp"
#include "job/with_ranks.hpp"
#include "sim/team_in_turns.hpp"
#include "sim/watched_disk.hpp"
#include "temporary_folder.hpp"

namespace driftmesh::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kSlice = 0.1;  // seconds

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Files files_in(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = content_of(entry.path());
  return files;
}

/// Temporary files as those of a process that has ended, unlike this one.
Files of_the_dead(Files files) {
  constexpr const char* kNoProcess = "-4194399-";
  const std::string own = "-" + std::to_string(::getpid()) + "-";
  Files renamed;
  for (auto& [name, content] : files) {
    std::string now = name;
    if (const std::size_t at = name.rfind(own); at != std::string::npos) now.replace(at, own.size(), kNoProcess);
    renamed[now] = std::move(content);
  }
  return renamed;
}

/// What all ranks of a life have in common.
struct Shared {
  Life life;
  fs::path folder;
  IdVector<Rank, std::int64_t> first, latest;  // triangles; -1: not known yet
  Sabotage sabotage;
};

std::int64_t sum(const IdVector<Rank, std::int64_t>& all) {
  std::int64_t sum = 0;
  for (const std::int64_t one : all) sum += std::max<std::int64_t>(one, 0);
  return sum;
}

/// One rank's watch, by which its work takes time.
class RankWatch final : public job::Watch {
 public:
  RankWatch(Turns& turns, Rank rank, Shared& shared) : turns_(turns), rank_(rank), shared_(shared) {}

  void refining(std::int64_t triangles, double /*forecast*/) override {
    shared_.latest[rank_] = triangles;
    if (shared_.first[rank_] < 0) {
      shared_.first[rank_] = triangles;
      shared_.life.began = turns_.now();
    }
    turns_.spend(rank_, kSlice);
  }
  void warned(const std::string& warning) override {
    shared_.life.refused += warning.starts_with("no checkpoint was written") ? 1 : 0;
  }
  void stalled(const std::string& why) override { shared_.life.lines.push_back(why); }

 private:
  Turns& turns_;
  Rank rank_;
  Shared& shared_;
};

/// One rank's disk, which is that of all.
class RankDisk final : public DiskWatch {
 public:
  RankDisk(Turns& turns, Rank rank, Shared& shared) : turns_(turns), rank_(rank), shared_(shared) {}

  [[nodiscard]] std::ptrdiff_t about_to_write(std::size_t bytes, bool by_hdf5) override {
    const Turns::Written written = turns_.writes(rank_, bytes);
    is_last_ = written.is_last;
    // Having met an error, HDF5 says at the end of the process that it cannot close.
    return written.is_refused && !by_hdf5 ? -1 : static_cast<std::ptrdiff_t>(written.bytes);
  }
  [[nodiscard]] bool is_over() override {
    if (shared_.sabotage == Sabotage::kEarlyRename && !turns_.ended()) rename_early();
    if (is_last_) turns_.end();
    return is_last_;
  }
  void about_to_rename(const std::string& /*from*/, const std::string& to) override {
    if (!is_checkpoint(to)) return;
    moment_ = turns_.renames(rank_);
    if (moment_ == Turns::Moment::kBefore) turns_.end();
  }
  void has_renamed(const std::string& to) override {
    if (!is_checkpoint(to) || turns_.ended()) return;
    shared_.life.saved = Saved{turns_.now(), sum(shared_.latest), content_of(to)};
    ++shared_.life.saves;
    if (moment_ == Turns::Moment::kAfter) turns_.end();
  }

 private:
  [[nodiscard]] static bool is_checkpoint(const std::string& path) { return fs::path(path).filename() == kCheckpoint; }
  void rename_early() const {
    for (const auto& entry : fs::directory_iterator(shared_.folder))
      if (const std::string name = entry.path().filename().string();
          name.starts_with(kCheckpoint) && name != kCheckpoint)
        fs::copy_file(entry.path(), shared_.folder / kCheckpoint, fs::copy_options::overwrite_existing);
  }

  Turns& turns_;
  Rank rank_;
  Shared& shared_;
  bool is_last_ = false;
  Turns::Moment moment_ = Turns::Moment::kNever;
};

void make_at(job::Place& place, const LifePlan& plan, const job::Request& request, job::Watch& watch, Life& life) {
  job::RunRecord record;
  const auto made = job::make({request, job::kLibrary, plan.given}, place, record, watch);
  made->report(record);
  if (!place.leads()) return;
  life.digest = record.digest;
  life.triangles = record.triangles;
}

void work_of(const LifePlan& plan, job::Team& team, job::Watch& watch, Life& life) {
  job::Request request = plan.request;
  if (!request.run.resume.empty()) request = job::resumed_request(request, {});
  if (request.run.method != job::Method::kRounds) {
    job::OnRanks place(team, balancer::make_policy);
    return make_at(place, plan, request, watch, life);
  }
  job::with_ranks(team, [&](Ranks& ranks) {
    job::RoundsOnRanks place(team, ranks, 1);
    ranks.alike([&] { make_at(place, plan, request, watch, life); });
  });
}

LifePlan in_folder(LifePlan plan, const fs::path& folder) {
  for (std::string* const file : {&plan.request.run.checkpoint, &plan.request.run.resume})
    if (!file->empty()) *file = (folder / *file).string();
  return plan;
}

}  // namespace

Life live(const LifePlan& wanted, const Files& files, Sabotage sabotage) {
  const TemporaryFolder folder;
  for (const auto& [name, content] : files) std::ofstream(folder.path() / name, std::ios::binary) << content;
  const LifePlan plan = in_folder(wanted, folder.path());
  const auto ranks = static_cast<std::size_t>(plan.ranks);
  Shared shared{{}, folder.path(), {}, {}, sabotage};
  for (std::size_t r = 0; r < ranks; ++r) {
    shared.first.push_back(-1);
    shared.latest.push_back(-1);
  }
  Life& life = shared.life;
  Turns turns(plan.ranks, plan.seed, plan.faults);
  Post post(turns);
  turns.run(
      [&](Rank r) {
        RankWatch watch(turns, r, shared);
        RankDisk disk(turns, r, shared);
        const WatchedDisk watched(disk);
        try {
          TeamInTurns team(post, r, plan.ranks, life.abort);
          work_of(plan, team, watch, life);
        } catch (const std::exception& error) {
          if (std::ranges::find(life.errors, error.what()) == life.errors.end()) life.errors.emplace_back(error.what());
        }
      },
      [&] { life.files = files_in(folder.path()); });
  std::signal(SIGTERM, SIG_DFL);  // NotedSignals of several ranks in one process restore those of each other
  life.ranks = plan.ranks;
  life.stuck = turns.stuck();
  life.ended = turns.ended();
  life.met = turns.met();
  life.seconds = turns.now();
  life.first_triangles = sum(shared.first);
  life.has_begun = std::ranges::none_of(shared.first, [](std::int64_t one) { return one < 0; });
  if (!life.ended) life.files = files_in(folder.path());
  life.files = of_the_dead(std::move(life.files));
  return std::move(shared.life);
}

}  // namespace driftmesh::sim
