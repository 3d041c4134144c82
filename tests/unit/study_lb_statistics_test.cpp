#include <doctest/doctest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "study/lb_statistics.hpp"
#include "support/id_literals.hpp"

using namespace driftmesh;
using namespace driftmesh::study;
using Json = nlohmann::json;

namespace {

/// Two ranks and two subdomains, which both start on rank 0; the second one works there first and then on rank 1.
ExperimentRun two_ranks(std::int32_t phases) {
  ExperimentRun run;
  run.request.lb_phases = phases;
  run.plan.owners = {0_rank, 0_rank};
  run.plan.decomposition.subdomains.resize(2);
  run.plan.decomposition.subdomains[1_sub].centroid = {3, 4};
  run.speeds = {1e6, 2e6};
  run.outcome.makespan = 8;
  run.outcome.ranks.resize(2);
  run.outcome.moves = {{1_sub, 0_rank, 1_rank, 3.0, 3.5, 100}};
  run.outcome.samples = {{2, 0_rank, 0, 0, 2.0, 0_sub}, {3, 0_rank, 0, 0, 1.0, 1_sub}, {7, 1_rank, 0, 0, 3.5, 1_sub}};
  run.outcome.splits = {{2, 0_rank, 0_sub, 1_sub, 5}, {7, 1_rank, 1_sub, 0_sub, 2}};
  return run;
}

struct Task {
  double time = 0;
  int index = -1;  // index of a subdomain
};

/// The tasks of one rank in one phase.
std::vector<Task> tasks(const std::vector<std::string>& files, std::size_t rank, std::size_t phase) {
  std::vector<Task> list;
  const Json file = Json::parse(files[rank]);
  for (const Json& task : file.at("phases").at(phase).at("tasks")) {
    const Json& entity = task.at("entity");
    CHECK(task.at("node") == rank);
    list.push_back({task.at("time"), entity.at("migratable") ? entity.at("index").at(0).get<int>() : -1});
  }
  return list;
}

using Kind = Json::value_t;

/// Fields with their types: required and optional ones.
struct Fields {
  std::map<std::string, Kind> required, optional;
};

const Kind kWhole = Kind::number_integer, kReal = Kind::number_float;
const Fields kFile{{{"phases", Kind::array}}, {{"metadata", Kind::object}, {"type", Kind::string}}};
const Fields kPhase{{{"id", kWhole}, {"tasks", Kind::array}, {"communications", Kind::array}}, {}};
const Fields kTask{{{"entity", Kind::object}, {"node", kWhole}, {"resource", Kind::string}, {"time", kReal}},
                   {{"attributes", Kind::object}, {"subphases", Kind::array}, {"user_defined", Kind::object}}};
const Fields kEntity{{{"home", kWhole}, {"id", kWhole}, {"migratable", Kind::boolean}, {"type", Kind::string}},
                     {{"collection_id", kWhole}, {"index", Kind::array}, {"objgroup_id", kWhole}, {"seq_id", kWhole}}};
const Fields kCommunication{
    {{"type", Kind::string}, {"from", Kind::object}, {"to", Kind::object}, {"messages", kWhole}, {"bytes", kReal}}, {}};

/// Integers are one type for the tools; only this library distinguishes signed from unsigned.
Kind kind_of(const Json& value) {
  return value.is_number_integer() ? kWhole : value.type();
}

void check_fields(const Json& object, const Fields& fields) {
  INFO(object.dump());
  for (const auto& [name, kind] : fields.required) {
    INFO(name);
    REQUIRE(object.contains(name));
    CHECK(kind_of(object.at(name)) == kind);
  }
  for (const auto& [name, value] : object.items()) {
    INFO(name);
    const auto known = fields.optional.find(name);
    if (known != fields.optional.end()) CHECK(kind_of(value) == known->second);
    CHECK((known != fields.optional.end() || fields.required.count(name) > 0));
  }
}

void check_entity(const Json& entity) {
  check_fields(entity, kEntity);
  const std::int64_t id = entity.at("id");
  CHECK(entity.at("type") == "object");
  CHECK((id >> 2 & 0xffff) == entity.at("home").get<std::int64_t>());  // vt reads it from the number
  CHECK((id & 3) == (entity.at("migratable") ? 3 : 1));
  CHECK(entity.contains("collection_id") == entity.at("migratable").get<bool>());
}

void check_task(const Json& task, std::size_t rank) {
  check_fields(task, kTask);
  check_entity(task.at("entity"));
  CHECK(task.at("node") == rank);
  CHECK(task.at("time") >= 0);
  const Json attributes = task.value("attributes", Json::object());
  for (const auto& [name, value] : attributes.items()) CHECK_MESSAGE((value.is_number() || value.is_string()), name);
  if (!task.contains("user_defined") || task.at("user_defined").empty()) return;
  for (const char* size : {"task_footprint_bytes", "task_working_bytes"}) {
    REQUIRE(task.at("user_defined").contains(size));
    CHECK(kind_of(task.at("user_defined").at(size)) == kReal);
  }
}

/// One phase in the files of all ranks: each subdomain is one task, and each communication is between two different
/// tasks.
void check_phase(const std::vector<Json>& files, std::size_t phase) {
  std::set<std::int64_t> tasks;
  for (std::size_t rank = 0; rank < files.size(); ++rank) {
    const Json& part = files[rank].at("phases").at(phase);
    check_fields(part, kPhase);
    CHECK(part.at("id") == phase);
    for (const Json& task : part.at("tasks")) {
      check_task(task, rank);
      CHECK(tasks.insert(task.at("entity").at("id").get<std::int64_t>()).second);
    }
  }
  std::set<std::pair<std::int64_t, std::int64_t>> edges;
  for (const Json& file : files)
    for (const Json& edge : file.at("phases").at(phase).at("communications")) {
      check_fields(edge, kCommunication);
      const std::int64_t from = edge.at("from").at("id"), to = edge.at("to").at("id");
      for (const char* end : {"from", "to"}) check_entity(edge.at(end));
      CHECK((tasks.count(from) > 0 && tasks.count(to) > 0 && from != to));
      CHECK(edges.emplace(from, to).second);  // LBAF drops one of two
    }
}

}  // namespace

TEST_CASE("files have what vt's validator and LBAF's reader require, even without any work") {
  for (const std::int32_t phases : {1, 4, 7}) {
    INFO(phases);
    std::vector<Json> files;
    for (const std::string& text : lb_statistics(two_ranks(phases))) files.push_back(Json::parse(text));
    for (std::size_t rank = 0; rank < files.size(); ++rank) {
      check_fields(files[rank], kFile);
      CHECK(files[rank].at("metadata").at("type") == "LBDatafile");
      CHECK(files[rank].at("metadata").at("rank") == rank);
      REQUIRE(files[rank].at("phases").size() == static_cast<std::size_t>(phases));
    }
    for (std::size_t phase = 0; phase < static_cast<std::size_t>(phases); ++phase) check_phase(files, phase);
  }
}

TEST_CASE(
    "in each phase a subdomain counts where it worked longest, and the rest of its time stays with the other ranks") {
  const std::vector<std::string> files = lb_statistics(two_ranks(1));
  REQUIRE(files.size() == 2);
  const std::vector<Task> first = tasks(files, 0, 0), second = tasks(files, 1, 0);
  REQUIRE(first.size() == 2);
  CHECK(first[0].index == 0);
  CHECK(first[0].time == 2);
  CHECK(first[1].index == -1);
  CHECK(first[1].time == 1);  // subdomain 1, before it moved
  REQUIRE(second.size() == 2);
  CHECK(second[0].index == 1);
  CHECK(second[0].time == 3.5);
  CHECK(second[1].time == 0);
}

TEST_CASE("a slice that spans several phases is divided between them") {
  const std::vector<std::string> files = lb_statistics(two_ranks(4));  // phases of 2 s
  const auto time_on_1 = [&](std::size_t phase) {
    double sum = 0;
    for (const Task& task : tasks(files, 1, phase)) sum += task.time;
    return sum;
  };
  CHECK(time_on_1(0) == 0);
  CHECK(time_on_1(1) == 0.5);
  CHECK(time_on_1(2) == 2);
  CHECK(time_on_1(3) == 1);
  // Subdomain 1 worked longer on rank 0 in the second phase, and did nothing in the first.
  CHECK(tasks(files, 0, 0).size() == 3);
  CHECK(tasks(files, 0, 1)[1].index == 1);
  CHECK(tasks(files, 0, 1)[1].time == 1);
  CHECK(tasks(files, 1, 3)[0].index == 1);
}

TEST_CASE("numbers, speeds and communications of subdomains are in vt's form") {
  const std::vector<std::string> files = lb_statistics(two_ranks(1));
  const Json file = Json::parse(files[1]);
  CHECK(file.at("metadata").at("rank") == 1);
  CHECK(file.at("metadata").at("attributes").at("triangles_per_second") == 2e6);
  const Json& phase = file.at("phases").at(0);
  const Json& entity = phase.at("tasks").at(0).at("entity");
  CHECK(entity.at("home") == 0);
  CHECK(entity.at("id") == (2 << 18) + 3);
  CHECK(phase.at("tasks").at(0).at("attributes").at("y") == 4);
  CHECK(phase.at("tasks").at(1).at("entity").at("id") == (1 << 2) + 1);
  REQUIRE(phase.at("communications").size() == 1);
  CHECK(phase.at("communications").at(0).at("messages") == 2);
  CHECK(phase.at("communications").at(0).at("bytes") == 24.0);
  CHECK(phase.at("communications").at(0).at("from").at("index") == Json::array({1}));
  CHECK(Json::parse(files[0]).at("phases").at(0).at("communications").at(0).at("messages") == 5);
}
