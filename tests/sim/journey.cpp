#include "sim/journey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <random>

#include "distributed/parts_file.hpp"
#include "driftmesh/error.hpp"
#include "sim/team_in_turns.hpp"
#include "temporary_folder.hpp"

namespace driftmesh::sim {
namespace {

using Kind = Fault::Kind;

/// What delays a checkpoint, or prevents it.
bool delays(Kind kind) {
  return kind == Kind::kPause || kind == Kind::kSlow || kind == Kind::kLate || kind == Kind::kFull;
}

bool ends(Kind kind) {
  return kind == Kind::kKill || kind == Kind::kKillAtWrite || kind == Kind::kHang;
}

constexpr double kGiveUp = 10, kWalltime = 15;  // seconds after which a run in which a rank hangs ends

constexpr std::int64_t kLess = 3;  // triangles by which a slice may leave fewer: splits delete free points

/// Whether a checkpoint is as write_parts() leaves it. Returns what is wrong.
std::string damage(const std::string& content) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / kCheckpoint).string();
  std::ofstream(path, std::ios::binary) << content;
  try {
    const PartsFile file(path, kCheckpointFile);
    static_cast<void>(file.head(kCheckpointFile.head));
    for (std::size_t s = 0; s < file.ends().size(); ++s) static_cast<void>(file.part(static_cast<SubdomainId>(s)));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

const char* name_of(Kind kind) {
  constexpr std::array kNames{"killed", "killed at a write", "hung",      "told to end",
                              "paused", "slowed down",       "sent late", "refused bytes by the disk"};
  return kNames[static_cast<std::size_t>(kind)];
}

JourneyPlan JourneyPlan::from_seed(std::uint64_t seed) {
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15u + 7);
  const auto one_of = [&](const auto& values) { return values[random() % values.size()]; };
  const auto chance = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  JourneyPlan plan;
  plan.seed = seed;
  plan.domain = one_of(std::array{"square", "ell", "wedge", "apart", "regions"});
  plan.subdomains = one_of(std::array{4, 7, 12});
  plan.in_rounds = random() % 4 != 0;
  plan.presplit = random() % 4 == 0;
  plan.slice = one_of(std::array{3, 10, 30});
  plan.every = one_of(std::array{0.02, 0.1, 0.3});
  const std::uint64_t faulty = 1 + random() % 3;
  for (std::uint64_t k = 0; k <= faulty; ++k) {
    Leg& leg = plan.legs.emplace_back();
    do leg.ranks = one_of(std::array{1, 2, 3, 4, 5, 7});
    while (k > 0 && leg.ranks == plan.legs[k - 1].ranks);
    const auto befalls = [&](Kind kind, double lasts) {
      const double latest = k == 0 ? 1.0 : 0.5;
      leg.faults.push_back({kind, static_cast<Rank>(random() % static_cast<std::uint64_t>(leg.ranks)),
                            latest * chance(), lasts * chance(), chance()});
    };
    for (const Kind kind : {Kind::kPause, Kind::kSlow, Kind::kLate, Kind::kFull})
      if (random() % 5 == 0 && (k < faulty || kind != Kind::kFull)) befalls(kind, 3);
    if (k == faulty) break;
    constexpr std::array kInRounds{Kind::kKill,        Kind::kKill, Kind::kKill,     Kind::kKillAtWrite,
                                   Kind::kKillAtWrite, Kind::kHang, Kind::kTerminate};
    constexpr std::array kCoupled{Kind::kKill, Kind::kHang};
    const Kind kind = plan.in_rounds ? one_of(kInRounds) : one_of(kCoupled);
    befalls(kind, 2);
    if (kind == Kind::kHang) leg.faults.back().lasts = kWalltime;
  }
  return plan;
}

std::string JourneyPlan::describe() const {
  std::string text =
      fmt::format("seed {}: {} in {} subdomains, {}, presplit {}, slices of {}", seed, domain, subdomains,
                  in_rounds ? fmt::format("rounds, a checkpoint every {} of the time", every) : "coupled",
                  presplit ? "on" : "off", slice);
  for (const Leg& leg : legs) {
    text += fmt::format("; {} ranks", leg.ranks);
    for (const Fault& fault : leg.faults)
      text += fmt::format(", rank {} {} at {:.2f}", to_string(fault.rank), name_of(fault.kind), fault.at);
  }
  return text;
}

std::string words_of(const JourneyCounts& counts) {
  std::string text = fmt::format(
      "{} journeys, {} in rounds; {} runs, {} resumed, {} begun anew; {} checkpoints, {} refused, {} given up",
      counts.journeys, counts.in_rounds, counts.lives, counts.resumed, counts.anew, counts.saves, counts.refused,
      counts.given_up);
  for (const auto& [kind, count] : counts.faults) text += fmt::format(", {} {}", count, name_of(kind));
  return text;
}

/// One journey, with what its runs leave to each other.
class Journeys::Travel {
 public:
  Travel(Journeys& all, const JourneyPlan& plan, const LifePlan& life)
      : all_(all), plan_(plan), life_(life), whole_(all.whole(plan)) {}

  std::string go(JourneyCounts& counts) {
    for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
      const Life life = live_on(k, counts);
      if (std::string problem = judged(life); !problem.empty()) return fmt::format("run {}: {}", k + 1, problem);
      if (life.digest) return {};
      files_ = life.files;
      if (all_.between_) all_.between_(files_);
      if (life.saved) kept_ = life.saved->triangles;
    }
    return "the last run made no mesh";
  }

 private:
  Life live_on(std::size_t k, JourneyCounts& counts) {
    const JourneyPlan::Leg& leg = plan_.legs[k];
    LifePlan next = life_;
    next.ranks = leg.ranks;
    next.seed = plan_.seed * 16 + k;
    next.faults = leg.faults;
    for (Fault& fault : next.faults) fault.at *= whole_.seconds;
    if (plan_.in_rounds) {
      next.request.run.checkpoint = kCheckpoint;
      next.request.run.every = every_ = std::max(0.01, plan_.every * whole_.seconds);
      if (files_.contains(kCheckpoint)) next.request.run.resume = kCheckpoint;
    }
    resumes_ = !next.request.run.resume.empty();
    Life life = live(next, files_, all_.sabotage_);
    ++counts.lives;
    ++(resumes_ ? counts.resumed : counts.anew);
    counts.saves += life.saves;
    counts.refused += life.refused;
    counts.given_up += life.abort.empty() ? 0 : 1;
    for (const Fault& fault : life.met) ++counts.faults[fault.kind];
    if (plan_.in_rounds) counts.oldest = std::max(counts.oldest, overdue(life));
    return life;
  }

  std::string judged(const Life& life) {
    if (life.stuck) return "it hangs";
    for (const std::string& problem : {end(life), checkpoint(life), beginning(life), mesh(life)})
      if (!problem.empty()) return problem;
    constexpr double kLate = 6;  // seconds: a slice of each rank, and messages of all to all
    if (plan_.in_rounds && overdue(life) > kLate)
      return fmt::format("the last checkpoint was due {:.1f} s before the end", overdue(life));
    return {};
  }

  static bool has_met(const Life& life, Kind kind) {
    return std::ranges::any_of(life.met, [&](const Fault& fault) { return fault.kind == kind; });
  }

  /// Whether it ended as it had to.
  static std::string end(const Life& life) {
    const std::string said = life.abort + (life.errors.empty() ? "" : life.errors.front());
    if (!life.abort.empty()) return given_up(life);
    if (life.ended && std::ranges::none_of(life.met, [](const Fault& f) { return ends(f.kind); }))
      return "it was ended by nobody";
    if (life.digest || life.ended) return life.errors.empty() ? "" : "it met an error: " + said;
    const bool told = has_met(life, Kind::kTerminate) && said.find("stopped by SIGTERM") != std::string::npos;
    return told ? "" : "nobody ended it, but it made no mesh: " + said;
  }

  /// Only a rank that has hung is given up.
  static std::string given_up(const Life& life) {
    for (const Fault& fault : life.met)
      if (const std::string rank = to_string(fault.rank);
          (fault.kind == Kind::kHang || fault.kind == Kind::kKill) &&
          life.abort.find("rank " + rank + " on " + TeamInTurns::host_of(fault.rank) + " has not answered") !=
              std::string::npos)
        return {};
    return "a rank ended the job: " + life.abort;
  }

  /// Whether the last complete checkpoint is on the disk, and whole.
  std::string checkpoint(const Life& life) const {
    const auto before = files_.find(kCheckpoint), now = life.files.find(kCheckpoint);
    const std::string* const expected = life.saved               ? &life.saved->content
                                        : before == files_.end() ? nullptr
                                                                 : &before->second;
    if (expected == nullptr) return now == life.files.end() ? "" : "there is a checkpoint that nobody has completed";
    if (now == life.files.end()) return "the checkpoint is gone";
    if (now->second != *expected) return "the checkpoint is not the one that was completed last";
    if (!life.saved) return {};
    const std::string wrong = damage(now->second);
    return wrong.empty() ? "" : "the checkpoint is damaged: " + wrong;
  }

  /// Whether it went on with all that was kept, as far as triangles tell.
  std::string beginning(const Life& life) const {
    const std::int64_t lost = kept_ - life.first_triangles;
    if (!resumes_ || !life.has_begun || lost <= kLess * life.ranks) return {};
    return fmt::format("{} triangles were kept, but it began with {}", kept_, life.first_triangles);
  }

  std::string mesh(const Life& life) const {
    if (!life.digest) return {};
    if (plan_.in_rounds && *life.digest != whole_.digest)
      return fmt::format("another mesh: digest {:016x} instead of {:016x}", *life.digest, whole_.digest);
    if (std::abs(static_cast<double>(life.triangles - whole_.triangles)) > 0.3 * static_cast<double>(whole_.triangles))
      return fmt::format("{} triangles instead of about {}", life.triangles, whole_.triangles);
    for (const auto& [name, content] : life.files)
      if (name != kCheckpoint && !(life.ended && name.starts_with(kCheckpoint))) return "it leaves " + name;
    return {};
  }

  /// Seconds since a checkpoint was due in a run that nothing delayed, when it was ended.
  [[nodiscard]] double overdue(const Life& life) const {
    double end = -1;
    for (const Fault& fault : life.met) {
      if (delays(fault.kind)) return 0;
      if (ends(fault.kind)) end = fault.at;
    }
    if (end < 0 || !life.has_begun || life.digest) return 0;
    const double last = std::max(life.began, life.saved ? life.saved->at : 0);
    return std::max(0.0, end - last - every_ - std::min(1.0, every_));
  }

  Journeys& all_;
  const JourneyPlan& plan_;
  const LifePlan& life_;
  const Whole& whole_;
  double every_ = 0;
  Files files_;
  std::int64_t kept_ = 0;
  bool resumes_ = false;
};

std::string Journeys::travel(const JourneyPlan& plan) {
  ++counts_.journeys;
  counts_.in_rounds += plan.in_rounds ? 1 : 0;
  const LifePlan life = life_of(plan);
  return Travel(*this, plan, life).go(counts_);
}

LifePlan Journeys::life_of(const JourneyPlan& plan) {
  Domain& domain = domains_[plan.domain];
  LifePlan life;
  job::Request& request = life.request;
  static_cast<PlainBounds&>(request.bounds) = domain.bounds().plain;
  request.bounds.angle = domain.bounds().min_angle;
  request.run.method = plan.in_rounds ? job::Method::kRounds : job::Method::kCoupled;
  request.run.presplit = plan.presplit ? Presplit::kOn : Presplit::kOff;
  request.run.slice = plan.slice;
  request.patience = {.silence = 4, .give_up = kGiveUp};
  life.given.input = &domain.input();
  life.given.decomposition = &domain.cut(plan.subdomains);
  return life;
}

const Journeys::Whole& Journeys::whole(const JourneyPlan& plan) {
  const auto key = std::tuple(plan.domain, plan.subdomains, plan.in_rounds, plan.presplit, plan.slice);
  if (const auto known = wholes_.find(key); known != wholes_.end()) return known->second;
  LifePlan alone = life_of(plan);
  alone.ranks = 2;
  const Life life = live(alone, {});
  if (!life.digest)
    throw Error("a run that nothing befalls made no mesh: " + life.abort +
                (life.errors.empty() ? "" : life.errors.front()));
  return wholes_[key] = {*life.digest, life.seconds, life.triangles};
}

}  // namespace driftmesh::sim
