#include "study/recorded_run.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::study {
namespace {

using JsonValue = nlohmann::json;

/// Reads parts of a record; what is missing or of another kind is an Error about it.
class Record {
 public:
  explicit Record(const JsonValue& json) : json_(json) {}

  template <class T>
  [[nodiscard]] T get(const char* pointer) const {
    const JsonValue::json_pointer place(pointer);
    if (!json_.contains(place)) throw Error(std::string("has no ") + pointer);
    try {
      return json_.at(place).get<T>();
    } catch (const JsonValue::exception&) {
      throw Error(std::string("has another kind of ") + pointer);
    }
  }
  [[nodiscard]] std::vector<double> amounts(const char* pointer, std::size_t count) const {
    auto values = get<std::vector<double>>(pointer);
    if (values.size() != count) throw Error(std::string("has another number of ") + pointer + " than of subdomains");
    for (const double value : values)
      if (!std::isfinite(value) || value < 0) throw Error(std::string("has an invalid number in ") + pointer);
    return values;
  }

 private:
  const JsonValue& json_;
};

balancer::Layout layout_of(const Record& record, std::size_t ranks) {
  const auto owners = record.get<std::vector<std::int32_t>>("/cluster/owners_before");
  const auto x = record.get<std::vector<double>>("/cluster/subdomains/x");
  const auto y = record.get<std::vector<double>>("/cluster/subdomains/y");
  const auto forecast = record.amounts("/cluster/subdomains/forecast", owners.size());
  const auto neighbors = record.get<std::vector<std::vector<std::int32_t>>>("/cluster/subdomains/neighbors");
  const auto borders = record.get<std::vector<std::vector<double>>>("/cluster/subdomains/borders");
  if (x.size() != owners.size() || y.size() != owners.size() || neighbors.size() != owners.size() ||
      borders.size() != owners.size())
    throw Error("has lists of subdomains that differ in length");
  balancer::Layout layout;
  layout.ranks = static_cast<std::int32_t>(ranks);
  const auto count = static_cast<std::int32_t>(owners.size());
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (owners[i] < 0 || owners[i] >= layout.ranks) throw Error("gives a subdomain to a rank that is not there");
    balancer::Layout::Subdomain s{x[i], y[i], forecast[i], Rank{owners[i]}, {}, false};
    if (neighbors[i].size() != borders[i].size()) throw Error("has neighbors without borders");
    for (std::size_t k = 0; k < neighbors[i].size(); ++k) {
      if (neighbors[i][k] < 0 || neighbors[i][k] >= count) throw Error("has a neighbor that is not there");
      s.neighbors.push_back({SubdomainId{neighbors[i][k]}, borders[i][k]});
    }
    layout.subdomains.push_back(std::move(s));
  }
  return layout;
}

void read_options(const Record& record, RecordedRun& run) {
  balancer::ControllerOptions& options = run.options;
  options.look = record.get<double>("/experiment/balance.look");
  options.gap = record.get<double>("/experiment/balance.gap");
  options.interval = record.get<double>("/experiment/balance.interval");
  options.worth.gain = record.get<double>("/experiment/balance.gain");
  run.latency = record.get<double>("/experiment/cluster.latency");
  run.bandwidth = record.get<double>("/experiment/cluster.bandwidth");
  run.message_overhead = record.get<double>("/experiment/cluster.message-overhead");
  const auto scale = record.get<double>("/experiment/cluster.scale");
  options.reference_speed /= scale;
  options.work_to_start /= scale;
  options.cost.latency = run.latency + 2 * run.message_overhead;
  options.cost.bandwidth = run.bandwidth;
  run.slice = kTrianglesPerPoint * record.get<double>("/experiment/run.slice");
}

IdVector<Rank, protocol::SpeedSchedule> recorded_schedules(const JsonValue& changes, std::size_t ranks) {
  if (changes.empty()) return {};
  IdVector<Rank, std::vector<protocol::SpeedChange>> of_rank(ranks);
  for (const JsonValue& change : changes) {
    const Record c(change);
    const auto first = c.get<std::int32_t>("/rank"), count = c.get<std::int32_t>("/ranks");
    if (first < 0 || count < 0 || static_cast<std::size_t>(first) + static_cast<std::size_t>(count) > ranks)
      throw Error("changes the speed of a rank that is not there");
    for (std::int32_t r = first; r < first + count; ++r)
      of_rank[Rank{r}].push_back({c.get<double>("/at"), c.get<double>("/factor")});
  }
  IdVector<Rank, protocol::SpeedSchedule> schedules;
  for (const auto& steps : of_rank) schedules.push_back(protocol::SpeedSchedule(steps));
  return schedules;
}

RecordOfRun run_of(const JsonValue& json) {
  const Record record(json);
  RecordOfRun read;
  read.policy = record.get<std::string>("/experiment/balance.policy");
  read.seconds = record.get<double>("/cluster/seconds");
  read.ideal = record.get<double>("/cluster/ideal_seconds");
  read.oracle = record.get<double>("/cluster/oracle_seconds");
  read.moves = record.get<JsonValue>("/cluster/moves").size();
  const auto speeds = record.get<std::vector<double>>("/cluster/speeds");
  if (speeds.empty() || !std::ranges::all_of(speeds, [](double s) { return std::isfinite(s) && s > 0; }))
    throw Error("has ranks without speed");
  read.run.speeds = IdVector<Rank, double>(speeds);
  read.run.schedules = recorded_schedules(record.get<JsonValue>("/experiment/cluster.changes"), speeds.size());
  const balancer::Layout layout = layout_of(record, speeds.size());
  const auto work = record.amounts("/cluster/subdomains/work", layout.subdomains.size());
  for (const SubdomainId s : ids_of(layout.subdomains))
    read.run.work.push_back({0, work[to_index(s)], layout[s].predicted});
  read.run.layout = std::make_shared<const balancer::Layout>(layout);
  read_options(record, read.run);
  return read;
}

}  // namespace

RecordOfRun read_recorded_run(const std::string& path) {
  const JsonValue json = JsonValue::parse(read_file(path), nullptr, false);
  constexpr const char* kNext = "name the .json of a run that `driftmesh run` wrote";
  if (json.is_discarded()) throw InputError({path, 0}, "is not JSON", kNext);
  if (!json.is_object() || json.value("format", JsonValue()) != "driftmesh experiment run")
    throw InputError({path, 0}, "is not the record of an experiment's run", kNext);
  try {
    return run_of(json);
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    throw InputError({path, 0}, error.what(), kNext);
  }
}

}  // namespace driftmesh::study
