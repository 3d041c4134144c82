#include "study/lb_statistics.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "config/value_json.hpp"
#include "protocol/codec.hpp"
#include "study/json_text.hpp"

namespace driftmesh::study {
namespace {

using config::Json;

constexpr double kSplitBytes = protocol::kSplitPointBytes;
constexpr int kCollection = 1;  // the collection of all subdomains

// vt's object IDs: two bits for the kind, sixteen for the home rank, the rest for the object's own number.
constexpr std::int64_t kFixedObject = 1, kMovableObject = 3;
std::int64_t object_id(std::int64_t number, Rank home, std::int64_t kind) {
  return number << 18 | std::int64_t{to_int(home)} << 2 | kind;
}

/// What happened in one phase.
struct Phase {
  std::map<SubdomainId, std::map<Rank, double>> worked;              // seconds
  std::map<std::pair<SubdomainId, SubdomainId>, std::int64_t> told;  // points on interfaces, by sender and receiver
  IdVector<SubdomainId, Rank> holder;                                // at the end of the phase

  /// The rank on which a subdomain counts as a task.
  [[nodiscard]] Rank place_of(SubdomainId s) const {
    const auto work = worked.find(s);
    if (work == worked.end()) return holder[s];
    return std::max_element(work->second.begin(), work->second.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }
};

class Phases {
 public:
  explicit Phases(const ExperimentRun& run)
      : run_(run),
        phases_(static_cast<std::size_t>(run.request.lb_phases)),
        length_(run.outcome.makespan / static_cast<double>(phases_.size())) {
    for (const LoadSample& s : run.outcome.samples)
      if (s.worked > 0) add_work(s);
    for (const SplitRecord& s : run.outcome.splits) phases_[phase_at(s.time)].told[{s.from, s.to}] += s.points;
    IdVector<SubdomainId, Rank> holder = run.plan.owners;
    auto move = run.outcome.moves.begin();
    for (std::size_t p = 0; p < phases_.size(); ++p) {
      for (; move != run.outcome.moves.end() && phase_at(move->left) <= p; ++move) holder[move->subdomain] = move->to;
      phases_[p].holder = holder;
    }
  }

  /// The phases of each rank's file.
  [[nodiscard]] IdVector<Rank, Json> json() const {
    IdVector<Rank, Json> of_rank(run_.outcome.ranks.size(), Json::array());
    for (std::size_t p = 0; p < phases_.size(); ++p) {
      IdVector<Rank, Json> parts = phase_json(phases_[p]);
      for (const Rank r : ids_of(parts)) {
        parts[r]["id"] = p;
        of_rank[r].push_back(std::move(parts[r]));
      }
    }
    return of_rank;
  }

 private:
  [[nodiscard]] std::size_t phase_at(double time) const {
    return std::min(static_cast<std::size_t>(std::max(time, 0.0) / length_), phases_.size() - 1);
  }

  /// Adds a slice of work, which may span several phases.
  void add_work(const LoadSample& s) {
    const double begin = s.time - s.worked;
    const std::size_t last = phase_at(s.time);
    for (std::size_t p = phase_at(begin); p <= last; ++p) {
      const double from = std::max(begin, length_ * static_cast<double>(p));
      const double to = p == last ? s.time : length_ * static_cast<double>(p + 1);
      if (to > from) phases_[p].worked[s.subdomain][s.rank] += to - from;
    }
  }

  [[nodiscard]] Json entity(SubdomainId s) const {
    const Rank home = run_.plan.owners[s];
    return {{"collection_id", kCollection},
            {"home", home},
            {"id", object_id(to_int(s) + 1, home, kMovableObject)},
            {"index", {s}},
            {"migratable", true},
            {"type", "object"}};
  }

  // Describe the subdomain by attributes: LBAF expects memory figures in user_defined.
  [[nodiscard]] Json task(SubdomainId s, Rank rank, double seconds) const {
    const Decomposition::Subdomain& known = run_.plan.decomposition.subdomains[s];
    return {
        {"entity", entity(s)},
        {"node", rank},
        {"resource", "cpu"},
        {"time", seconds},
        {"attributes", {{"x", known.centroid.x}, {"y", known.centroid.y}, {"predicted_triangles", known.predicted}}}};
  }

  /// For a rank's work on subdomains that are tasks of other ranks.
  [[nodiscard]] static Json fixed_task(Rank rank, double seconds) {
    return {{"entity",
             {{"home", rank}, {"id", object_id(0, rank, kFixedObject)}, {"migratable", false}, {"type", "object"}}},
            {"node", rank},
            {"resource", "cpu"},
            {"time", seconds}};
  }

  [[nodiscard]] IdVector<Rank, Json> phase_json(const Phase& phase) const {
    // The list exists even if empty: the validator of communications requires it.
    IdVector<Rank, Json> of_rank(run_.outcome.ranks.size(),
                                 {{"id", 0}, {"tasks", Json::array()}, {"communications", Json::array()}});
    IdVector<Rank, double> elsewhere(of_rank.size(), 0);
    for (const SubdomainId s : ids_of(phase.holder)) {
      const Rank place = phase.place_of(s);
      double seconds = 0;
      if (const auto work = phase.worked.find(s); work != phase.worked.end())
        for (const auto& [rank, worked] : work->second) (rank == place ? seconds : elsewhere[rank]) += worked;
      of_rank[place]["tasks"].push_back(task(s, place, seconds));
    }
    for (const Rank r : ids_of(of_rank)) of_rank[r]["tasks"].push_back(fixed_task(r, elsewhere[r]));
    for (const auto& [ends, points] : phase.told)
      of_rank[phase.place_of(ends.first)]["communications"].push_back(
          {{"type", "SendRecv"},
           {"from", entity(ends.first)},
           {"to", entity(ends.second)},
           {"messages", points},
           {"bytes", kSplitBytes * static_cast<double>(points)}});
    return of_rank;
  }

  const ExperimentRun& run_;
  std::vector<Phase> phases_;
  double length_;
};

}  // namespace

std::vector<std::string> lb_statistics(const ExperimentRun& run) {
  std::vector<std::string> texts;
  const Json none = {{"list", Json::array()}, {"range", Json::array()}};
  IdVector<Rank, Json> of_rank = Phases(run).json();
  for (const Rank rank : ids_of(of_rank)) {
    Json& phases = of_rank[rank];
    const Json metadata = {
        {"type", "LBDatafile"},
        {"rank", rank},
        {"phases", {{"count", phases.size()}, {"skipped", none}, {"identical_to_previous", none}}},
        {"attributes", {{"experiment", run.request.name}, {"triangles_per_second", run.speeds[rank]}}}};
    texts.push_back(json_text(Json({{"metadata", metadata}, {"phases", std::move(phases)}}), 1));
  }
  return texts;
}

}  // namespace driftmesh::study
