#include "study/recorded_run.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "job/keys.hpp"
#include "job/request.hpp"

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
  const ClusterSpec& cluster = run.cluster;
  options.reference_speed /= cluster.scale;
  options.cost.latency = cluster.latency + 2 * cluster.message_overhead;
  options.cost.bandwidth = cluster.bandwidth;
  run.slice = record.get<std::int64_t>("/experiment/run.slice");
  job::Request request;
  const job::KeyPath order = job::find_key("run.order");
  job::store(request, order, job::read_value(*order.key, record.get<std::string>("/experiment/run.order")));
  run.order = request.run.order;
}

/// Each rank is a group of its own.
ClusterSpec cluster_of(const Record& record) {
  ClusterSpec cluster;
  for (const auto speed : record.get<std::vector<double>>("/cluster/speeds")) {
    if (!std::isfinite(speed) || speed <= 0) throw Error("has ranks without speed");
    cluster.groups.push_back({"", 1, speed});
  }
  if (cluster.groups.empty()) throw Error("has ranks without speed");
  for (const JsonValue& change : record.get<JsonValue>("/experiment/cluster.changes")) {
    const Record c(change);
    cluster.changes.push_back(
        {c.get<std::int32_t>("/rank"), c.get<std::int32_t>("/ranks"), c.get<double>("/at"), c.get<double>("/factor")});
  }
  cluster.memory = record.get<double>("/experiment/cluster.memory");
  cluster.latency = record.get<double>("/experiment/cluster.latency");
  cluster.bandwidth = record.get<double>("/experiment/cluster.bandwidth");
  cluster.ranks_per_host = record.get<std::int32_t>("/experiment/cluster.ranks-per-host");
  cluster.message_overhead = record.get<double>("/experiment/cluster.message-overhead");
  cluster.scale = record.get<double>("/experiment/cluster.scale");
  static_cast<void>(schedules_of(cluster));
  return cluster;
}

RecordOfRun run_of(const JsonValue& json) {
  const Record record(json);
  RecordOfRun read;
  read.policy = record.get<std::string>("/experiment/balance.policy");
  read.seconds = record.get<double>("/cluster/seconds");
  read.ideal = record.get<double>("/cluster/ideal_seconds");
  read.oracle = record.get<double>("/cluster/oracle_seconds");
  read.moves = record.get<JsonValue>("/cluster/moves").size();
  read.run.cluster = cluster_of(record);
  const balancer::Layout layout = layout_of(record, read.run.cluster.groups.size());
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
