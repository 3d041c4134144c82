#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/read_file.hpp"
#include "config/costs_file.hpp"
#include "config/experiment.hpp"
#include "config/value_json.hpp"
#include "config/words.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/keys.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::config;
using namespace driftmesh::job;

namespace {

constexpr const char* kLeast = "input: {generate: pipe}\ncluster: {ranks: 2}\n";

class Files {
 public:
  config::Experiment read(const std::string& yaml, const std::vector<std::string>& settings = {}) const {
    std::ofstream(path()) << yaml;
    return read_experiment(path(), settings);
  }
  [[nodiscard]] std::string path() const { return (folder_.path() / "test.yaml").string(); }
  [[nodiscard]] std::string folder() const { return folder_.path().string(); }

 private:
  TemporaryFolder folder_;
};

/// The message for an invalid file, starting with its name or the setting.
std::string message_for(const std::string& yaml, const std::vector<std::string>& settings = {}) {
  try {
    static_cast<void>(Files().read(yaml, settings));
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find(message.starts_with("--set") ? "--set" : "test.yaml"));
  }
  return "no error";
}

}  // namespace

TEST_CASE("a file sets the keys it names, and the others keep their defaults") {
  const Files files;
  const config::Experiment file = files.read(
      "input:\n  generate: bay\n  parameters: {resolution: 500, seed: 7}\n"
      "bounds:\n  triangles: 1e5\n"
      "cluster:\n  groups:\n    - {name: old, ranks: 2, speed: 110e3}\n    - {ranks: 1}\n"
      "run:\n  order: largest\n");
  REQUIRE(file.points.size() == 1);
  const Request& e = file.points[0].request;
  CHECK(e.name == "test");
  CHECK(e.input.parameters == std::map<std::string, std::string>{{"resolution", "500"}, {"seed", "7"}});
  CHECK(e.bounds.triangles == 1e5);
  CHECK(e.bounds.angle == 20);
  CHECK(e.run.order == WorkOrder::kLargest);
  REQUIRE(e.cluster.groups.size() == 2);
  CHECK(e.cluster.groups[0].name == "old");
  CHECK(e.cluster.groups[0].speed == 110e3);
  CHECK(e.cluster.groups[1].speed == 0);
  CHECK(ranks_of(cluster_of(e)) == 3);
}

TEST_CASE("files are relative to the experiment's, and those of settings are not") {
  const Files files;
  const std::string yaml = "input: {file: in/a.poly}\ncluster: {ranks: 1}\n";
  CHECK(files.read(yaml).base.input.file == files.folder() + "/in/a.poly");
  CHECK(files.read(yaml, {"input.file=b.poly"}).base.input.file == "b.poly");
}

TEST_CASE("sweeps are all combinations, the last key fastest") {
  const Files files;
  const config::Experiment file = files.read(
      "input: {generate: pipe}\n"
      "sweep:\n  cluster.ranks: [2, 4]\n  input.parameters.channels: [4, 5, 6]\n");
  REQUIRE(file.points.size() == 6);
  CHECK(file.points[1].request.cluster.ranks == 2);
  CHECK(file.points[1].request.input.parameters.at("channels") == "5");
  CHECK(file.points[3].request.cluster.ranks == 4);
  CHECK(file.points[3].request.input.parameters.at("channels") == "4");
  CHECK(file.points[5].values ==
        std::vector<std::pair<std::string, Value>>{{"cluster.ranks", std::int64_t{4}},
                                                   {"input.parameters.channels", std::string("6")}});
}

TEST_CASE("a sweep may name a key by its option") {
  const Files files;
  const std::string yaml = "input: {generate: pipe}\ncluster: {ranks: 2}\n";
  const config::Experiment swept = files.read(yaml + "sweep: {area: [1k, 2k], balance: [none, greedy]}\n");
  REQUIRE(swept.points.size() == 4);
  CHECK(swept.points[2].request.bounds.area == 2000);
  CHECK(swept.points[3].request.balance.policy == "greedy");
  CHECK(swept.points[3].values[1].first == "balance.policy");
  CHECK(files.read(yaml + "sweep: {area: [1k, 2k]}\n", {"bounds.area=5k"}).points.size() == 1);
  CHECK(message_for(yaml + "sweep: {area: [1], bounds.area: [2]}\n") ==
        "test.yaml:3:20: sweep: 'bounds.area' is given twice; join the two");
  CHECK(message_for(yaml + "sweep: {no-region-areas: [true, false]}\n") ==
        "test.yaml:3:9: sweep: 'no-region-areas' is not a key; sweep over 'bounds.region-areas'");
}

TEST_CASE("settings override the file and its sweeps") {
  const Files files;
  const std::string yaml =
      "input: {generate: pipe}\ncluster: {ranks: 3}\nsweep: {cluster.ranks: [2, 4], run.aggregation: [1, 8]}\n";
  CHECK(files.read(yaml).points.size() == 4);
  const config::Experiment one = files.read(yaml, {"cluster.ranks=5"});
  REQUIRE(one.points.size() == 2);
  CHECK(one.points[1].request.cluster.ranks == 5);
  CHECK(files.read(yaml, {"cluster.ranks=[1, 2, 3]"}).points.size() == 6);
  CHECK(files.read(kLeast, {"cluster.groups=[{ranks: 4}]", "cluster.ranks=0"}).base.cluster.groups.size() == 1);
  // A text with a colon that YAML takes for a table's.
  CHECK(files.read(kLeast, {"sizing.size=x < 1 ? 0.1 : 0.2"}).base.sizing.expression == "x < 1 ? 0.1 : 0.2");
}

TEST_CASE("errors name the place and what was probably meant") {
  CHECK(message_for("input:\n  fil: a.poly\n") ==
        "test.yaml:2:3: unknown key 'input.fil'; the nearest one is 'input.file'");
  CHECK(message_for("sizing:\n  courant-step: 8\n") ==
        "test.yaml:2:3: 'sizing.courant-step' is a key of driftmesh mesh, not of driftmesh run; remove it");
  CHECK(message_for("clutser: {ranks: 2}\n") == "test.yaml:1:1: unknown key 'clutser'; the nearest one is 'cluster'");
  CHECK(message_for("bounds: {angle: steep}\n") ==
        "test.yaml:1:17: 'bounds.angle' is 'steep'; give a number, as in 20, 1.5e3 or 5k");
  CHECK(message_for("bounds: {angle: 35}\n") ==
        "test.yaml:1:17: 'bounds.angle' is 35; it must be at most 34: above that, refinement may not terminate");
  CHECK(message_for("cluster:\n  bandwidth: 0\n") == "test.yaml:2:14: 'cluster.bandwidth' is 0; it must be above 0");
  CHECK(message_for("cluster: {ranks: 2.5}\n") == "test.yaml:1:18: 'cluster.ranks' is 2.5; give a whole number");
  CHECK(message_for("run: {order: largets}\n") ==
        "test.yaml:1:14: 'run.order' is 'largets'; the nearest valid value is 'largest'");
  CHECK(message_for("report: yes\n") == "test.yaml:1:9: 'report' is 'yes'; it is either true or false");
  CHECK(message_for("cluster:\n  groups:\n    - {rank: 2}\n") ==
        "test.yaml:3:8: 'cluster.groups' has no field 'rank'; the nearest one is 'ranks'");
  CHECK(message_for("cluster: {ranks: 2}\ncluster: {latency: 1}\n") ==
        "test.yaml:2:1: 'cluster' is given twice; join the two");
  CHECK(message_for("sweep: {cluster.ranks: [1]}\nsweep: {run.aggregation: [1]}\n") ==
        "test.yaml:2:1: 'sweep' is given twice; join the two");
  CHECK(message_for("cluster: {ranks: 2}\ncluster:\n") == "test.yaml:2:1: 'cluster' is given twice; join the two");
  CHECK(message_for("bounds: {angle: 20, angle: 21}\n") ==
        "test.yaml:1:21: 'bounds.angle' is given twice; remove one of them");
  CHECK(message_for(std::string(kLeast) + std::string("# \0\nbounds: {angle: 3}\n", 23)) ==
        "test.yaml:3: holds a control character; this is not YAML");
  CHECK(message_for("bounds: 3\n") == "test.yaml:1:9: 'bounds' has no single value; give its keys, indented, below");
  CHECK(message_for("seed:\n").find("'seed' has no value") != std::string::npos);
  CHECK(message_for("- 1\n").find("test.yaml:1:1: not a list of 'key: value' lines") == 0);
  CHECK(message_for("input: [\n").find("this is not YAML") != std::string::npos);
  CHECK(message_for("sweep: {cluster.rank: [1]}\n").find("the nearest one is 'cluster.ranks'") != std::string::npos);
  CHECK(message_for("sweep: {cluster.ranks: 1}\n").find("has no list of values") != std::string::npos);
  CHECK(message_for("sweep: {cluster.ranks: [1, many]}\n") ==
        "test.yaml:1:28: 'cluster.ranks' is 'many'; give a number, as in 20, 1.5e3 or 5k");
  CHECK(message_for(kLeast, {"bounds.angel=3"}) ==
        "--set bounds.angel=3: unknown key 'bounds.angel'; the nearest one is 'bounds.angle'");
  CHECK(message_for(kLeast, {"seed"}) == "--set seed: no value; write --set key=value");
}

TEST_CASE("contradictory values are reported at the place of one of them") {
  CHECK(message_for("cluster: {ranks: 2}\n") ==
        "test.yaml: 'input.file' is missing; name a file with input.file, or what to generate with "
        "input.generate");
  CHECK(message_for("input: {generate: pipe}\n").find("'cluster.ranks' is 0; give") != std::string::npos);
  CHECK(message_for("input:\n  generate: pip\ncluster: {ranks: 2}\n")
            .find("test.yaml:2:13: 'input.generate' is 'pip'; the nearest") == 0);
  CHECK(message_for("input: {generate: pipe, parameters: {chanels: 3}}\ncluster: {ranks: 2}\n")
            .find("the nearest one is 'channels'") != std::string::npos);
  CHECK(message_for(std::string(kLeast) + "bounds:\n  area: 1\n  triangles: 5\n").find("test.yaml:5:14: ") == 0);
  CHECK(message_for(std::string(kLeast) + "bounds: {area: 1}\nsweep: {bounds.triangles: [0, 100]}\n")
            .find("'bounds.triangles' cannot be combined with bounds.area") != std::string::npos);
}

TEST_CASE("a list of numbers is one value, and a list of lists is a sweep") {
  const Files files;
  CHECK(files.read(std::string(kLeast), {"cluster.drag=[1, 0.5]"}).base.cluster.drag == std::vector<double>{1, 0.5});
  CHECK(files.read(std::string(kLeast), {"cluster.drag=[]"}).base.cluster.drag.empty());
  const config::Experiment swept = files.read(kLeast, {"cluster.drag=[[1, 1], [1, 0.25]]"});
  REQUIRE(swept.points.size() == 2);
  CHECK(swept.points[1].request.cluster.drag == std::vector<double>{1, 0.25});
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 2, drag: [1, slow]}\n") ==
        "test.yaml:2:31: 'cluster.drag' is 'slow'; give a number, as in 20, 1.5e3 or 5k");
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 2, drag: 0.5}\n").find("'cluster.drag' is not a list") !=
        std::string::npos);
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 2, drag: [1, 0]}\n").find("at least 0.01") !=
        std::string::npos);
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 3, drag: [1, 1]}\n").find("test.yaml:2:27: ") == 0);
}

TEST_CASE("a parameter that names a policy applies only to it") {
  const Files files;
  const config::Experiment file = files.read(kLeast, {"balance.parameters={zoltan.method: rcb, greedy.tolerance: 0.1}",
                                                      "balance.policy=[none, zoltan, greedy]"});
  REQUIRE(file.points.size() == 3);
  const auto parameters = [&](std::size_t point) { return parameters_of_policy(file.points[point].request); };
  CHECK(parameters(0).empty());
  CHECK(parameters(1) == std::map<std::string, std::string>{{"method", "rcb"}});
  CHECK(parameters(2) == std::map<std::string, std::string>{{"tolerance", "0.1"}});
  CHECK(message_for(kLeast, {"balance.parameters={zoltn.method: rcb}"}).find("the nearest one is 'zoltan'") !=
        std::string::npos);
  CHECK(message_for(kLeast, {"balance.policy=zoltan", "balance.parameters={zoltan.methd: rcb}"}).find("methd") !=
        std::string::npos);
}

TEST_CASE("a wrong number of processes is reported at the place that sets it") {
  const Files files;
  const auto message = [&](const std::string& yaml, std::int32_t processes) {
    try {
      check_processes(files.read(yaml), processes);
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.substr(text.find("test.yaml"));
    }
    return std::string("none");
  };
  const std::string input = "input: {generate: pipe}\n";
  CHECK(message(input + "cluster: {ranks: 2}\n", 1) == "none");
  CHECK(message(input + "cluster: {ranks: 2}\n", 2).find("test.yaml:2:1: 'cluster.kind'") == 0);
  CHECK(message(input + "cluster: {kind: real}\n", 5) == "none");
  CHECK(message(input + "cluster: {kind: real, ranks: 2}\n", 2) == "none");
  CHECK(message(input + "cluster: {kind: real, ranks: 2}\n", 3).find("test.yaml:2:30: 'cluster.ranks'") == 0);
  CHECK(message(input + "cluster: {kind: real, drag: [1, 0.5]}\n", 2) == "none");
  CHECK(message(input + "cluster: {kind: real, drag: [1, 0.5]}\n", 3).find("test.yaml:2:29: 'cluster.drag'") == 0);
  CHECK(message(input + "cluster: {ranks: 1}\nsweep: {cluster.kind: [real, simulated]}\n", 1) == "none");
}

TEST_CASE("a complete experiment reads back as itself") {
  const Files files;
  const config::Experiment file = files.read(
      "name: \"odd: name, #1\"\ninput: {generate: holes, parameters: {columns: 3}}\n"
      "sizing: {size: \"0.1 + 0.05 * hypot(x, y)\", min: 1e-3}\n"
      "cluster:\n  bandwidth: 12.5e6\n  groups: [{name: \"a b\", ranks: 3, speed: 1.5e5}]\n"
      "sweep: {run.order: [given, backlog], decomposition.skew: [0, 0.5]}\n");
  const std::string text = experiment_text(file);
  const config::Experiment again = files.read(text);
  CHECK(experiment_text(again) == text);
  REQUIRE(again.points.size() == file.points.size());
  for (std::size_t i = 0; i < again.points.size(); ++i) {
    CHECK(again.points[i].values == file.points[i].values);
    CHECK(json_of(again.points[i].request, kExperiment) == json_of(file.points[i].request, kExperiment));
  }
}

TEST_CASE("a complete experiment finds its files from any folder") {
  const Files files, elsewhere;
  const config::Experiment file = files.read("input: {file: in/a.poly}\ncluster: {ranks: 1}\n",
                                             {"decomposition.file=d.txt", "sizing.background=[b.vtu, c.vtu]"});
  const config::Experiment again = elsewhere.read(experiment_text(file));
  const auto here = [](const char* name) { return (std::filesystem::current_path() / name).string(); };
  REQUIRE(again.points.size() == 2);
  const Request& e = again.points[1].request;
  CHECK(e.input.file == files.folder() + "/in/a.poly");
  CHECK(e.decomposition.file == here("d.txt"));
  CHECK(e.sizing.background == here("c.vtu"));
}

TEST_CASE("every key of an experiment takes its default from a file") {
  const Files files;
  for (const Key& key : keys()) {
    CAPTURE(key.name);
    if ((key.entry_points & kExperiment) == 0 || key.name.starts_with("input.") || key.name == "cluster.ranks")
      continue;
    const config::Experiment file = files.read(kLeast, {key.name + "=" + text_of(key.standard)});
    CHECK(key.load(file.base) == key.standard);
  }
}

TEST_CASE("the schema has every key, and the documentation shows the current keys") {
  const Json schema = Json::parse(json_schema());
  for (const Key& key : keys()) {
    if ((key.entry_points & kExperiment) == 0) continue;
    CAPTURE(key.name);
    Json at = schema;
    std::istringstream words(key.name);
    for (std::string word; std::getline(words, word, '.');) at = at.at("properties").at(word);
    CHECK(at.at("description").get<std::string>().starts_with(key.help));
    CHECK(schema.at("properties").at("sweep").at("properties").contains(key.name));
  }
  const std::string document = read_file(DRIFTMESH_SOURCE_DIR "/docs/experiments.md");
  CHECK_MESSAGE(document.find(keys_table()) != std::string::npos,
                "docs/experiments.md needs the table that driftmesh config --keys prints");
}

TEST_CASE("settings of one mesh name keys in full or by their options") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run.yaml").string();
  const auto read = [&](const std::string& yaml) {
    std::ofstream(path) << yaml;
    return read_settings(path).request;
  };
  const Request request = read(
      "input: in.poly\narea: 5k\nbounds: {angle: 25}\noutput: [a.vtu, b.msh]\nno-region-areas: true\nbalance: {gain: "
      "0.1}\n"
      "max-memory: 2G\n");
  CHECK(request.input.file == (folder.path() / "in.poly").string());
  CHECK(request.bounds.area == 5000);
  CHECK(request.bounds.angle == 25);
  CHECK(!request.bounds.region_areas);
  const std::string a = (folder.path() / "a.vtu").string(), b = (folder.path() / "b.msh").string();
  CHECK(request.output.meshes == std::vector<std::string>{a, b});
  CHECK(request.balance.gain == 0.1);
  CHECK(request.limits.max_memory == std::int64_t{2} << 30);
  CHECK(read("output: a.vtu\n").output.meshes == std::vector<std::string>{a});
  CHECK(read("output: '-'\n").output.meshes == std::vector<std::string>{"-"});
  const auto refusal = [&](const std::string& yaml) {
    try {
      static_cast<void>(read(yaml));
    } catch (const InputError& error) {
      const std::string message = error.what();
      return message.substr(message.find("run.yaml"));
    }
    return std::string("none");
  };
  CHECK(refusal("area: 1\nbounds: {area: 2}\n").find("run.yaml:2:10: 'bounds.area' is given twice") == 0);
  CHECK(refusal("anlge: 25\n") == "run.yaml:1:1: unknown key 'anlge'; the nearest one is 'angle'");
  CHECK(refusal("cluster: {kind: real}\n") ==
        "run.yaml:1:11: 'cluster.kind' is a key of driftmesh run, not of driftmesh mesh; remove it");
  CHECK(refusal("quiet: maybe\n").find("it is either true or false") != std::string::npos);
  const std::map<std::string, std::string> rasters = {{"depth", (folder.path() / "d=1.asc").string()},
                                                      {"waves", (folder.path() / "w.asc").string()}};
  CHECK(read("raster: {depth: d=1.asc, waves: w.asc}\n").input.rasters == rasters);
  CHECK(read("raster: [depth=d=1.asc, waves=w.asc]\n").input.rasters == rasters);
  CHECK(read("input: {rasters: [waves=w.asc, depth=d=1.asc]}\n").input.rasters == rasters);
  CHECK(refusal("raster: [depth=d.asc, w.asc]\n") ==
        "run.yaml:1:23: 'input.rasters' has 'w.asc' in its list; write NAME=VALUE, or a table, {name: value}");
  CHECK(refusal("raster: [depth=d.asc, depth=w.asc]\n") ==
        "run.yaml:1:23: 'input.rasters' has 'depth' twice; remove one of them");
  for (const char* none : {"output: ''\n", "output: ['']\n"})
    CHECK(refusal(none).ends_with("'output.meshes' is empty; give it a value, or leave it out"));
  CHECK(refusal("raster: depth\n") == "run.yaml:1:9: 'input.rasters' is not a table; write for example {name: value}");
}

TEST_CASE("every shipped experiment is valid") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(DRIFTMESH_SOURCE_DIR "/configs")) {
    if (entry.is_directory()) continue;
    CAPTURE(entry.path().string());
    ++files;
    CHECK_NOTHROW(static_cast<void>(read_experiment(entry.path().string(), {})));
  }
  CHECK(files > 0);
}

TEST_CASE("costs are read as they were written, and mistakes are found") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "costs.yaml").string();
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return read_costs(path);
  };
  CostModel costs;
  costs.point = 1e-6;
  costs.planning.unit["graph"] = 2e-6;
  const CostModel again = read(costs_text(costs));
  CHECK(again.point == costs.point);
  CHECK(again.planning.unit == costs.planning.unit);
  CHECK(read("{planning: {rcb: 1}}").planning.unit.at("rcb") == 1);
  for (const char* wrong :
       {"pint: 1", "point: -1", "point: soon", "planning: {grph: 1}", "planning: 3", "[1]", "{", "point: 1\n\x04"})
    CHECK_THROWS_AS(static_cast<void>(read(wrong)), InputError);
  CHECK_THROWS_WITH_AS(static_cast<void>(read("start: 1\npoint: soon\n")), doctest::Contains("costs.yaml:2:8: "),
                       InputError);
}
