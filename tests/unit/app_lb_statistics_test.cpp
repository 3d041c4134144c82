#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "app/lb_statistics.hpp"

using namespace driftmesh;
using namespace driftmesh::app;
using Json = nlohmann::json;

namespace {

/// Two ranks and two subdomains, which both start on rank 0; the second one works there first and then on rank 1.
ExperimentRun two_ranks(std::int32_t phases) {
  ExperimentRun run;
  run.experiment.lb_phases = phases;
  run.plan.owners = {0, 0};
  run.plan.decomposition.subdomains.resize(2);
  run.plan.decomposition.subdomains[1].centroid = {3, 4};
  run.speeds = {1e6, 2e6};
  run.outcome.makespan = 8;
  run.outcome.ranks.resize(2);
  run.outcome.moves = {{1, 0, 1, 3.0, 3.5, 100}};
  run.outcome.samples = {{2, 0, 0, 0, 2.0, 0}, {3, 0, 0, 0, 1.0, 1}, {7, 1, 0, 0, 3.5, 1}};
  run.outcome.splits = {{2, 0, 0, 1, 5}, {7, 1, 1, 0, 2}};
  return run;
}

struct Task {
  double time = 0;
  int index = -1;  // of a subdomain
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

}  // namespace

TEST_CASE("in one phase a subdomain counts where it worked longest, and the rest of its time stays where it was") {
  const std::vector<std::string> files = lb_statistics(two_ranks(1));
  REQUIRE(files.size() == 2);
  const std::vector<Task> first = tasks(files, 0, 0), second = tasks(files, 1, 0);
  REQUIRE(first.size() == 2);
  CHECK(first[0].index == 0);
  CHECK(first[0].time == 2);
  CHECK(first[1].index == -1);
  CHECK(first[1].time == 1);  // of subdomain 1, before it moved
  REQUIRE(second.size() == 2);
  CHECK(second[0].index == 1);
  CHECK(second[0].time == 3.5);
  CHECK(second[1].time == 0);
}

TEST_CASE("a slice that lies in several phases is divided between them") {
  const std::vector<std::string> files = lb_statistics(two_ranks(4));  // of 2 s each
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

TEST_CASE("numbers, speeds and what subdomains told each other are as vt knows them") {
  const std::vector<std::string> files = lb_statistics(two_ranks(1));
  const Json file = Json::parse(files[1]);
  CHECK(file.at("metadata").at("rank") == 1);
  CHECK(file.at("metadata").at("attributes").at("triangles_per_second") == 2e6);
  const Json& phase = file.at("phases").at(0);
  const Json& entity = phase.at("tasks").at(0).at("entity");
  CHECK(entity.at("home") == 0);
  CHECK(entity.at("id") == (2 << 18) + 3);
  CHECK(phase.at("tasks").at(0).at("user_defined").at("y") == 4);
  CHECK(phase.at("tasks").at(1).at("entity").at("id") == (1 << 2) + 1);
  REQUIRE(phase.at("communications").size() == 1);
  CHECK(phase.at("communications").at(0).at("messages") == 2);
  CHECK(phase.at("communications").at(0).at("bytes") == 24.0);
  CHECK(phase.at("communications").at(0).at("from").at("index") == Json::array({1}));
  CHECK(Json::parse(files[0]).at("phases").at(0).at("communications").at(0).at("messages") == 5);
}
