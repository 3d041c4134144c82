#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/read_file.hpp"
#include "experiment/experiment_file.hpp"
#include "experiment/key_words.hpp"
#include "experiment/prepare.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::experiment;

namespace {

constexpr const char* kLeast = "input: {generate: pipe}\ncluster: {ranks: 2}\n";

class Files {
 public:
  ExperimentFile read(const std::string& yaml, const std::vector<std::string>& settings = {}) const {
    std::ofstream(path()) << yaml;
    return read_experiment(path(), settings);
  }
  [[nodiscard]] std::string path() const { return (folder_.path() / "test.yaml").string(); }
  [[nodiscard]] std::string folder() const { return folder_.path().string(); }

 private:
  TemporaryFolder folder_;
};

/// The message for a file that is refused, from its name or from the setting on.
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

TEST_CASE("a file sets what it names, and the rest has its defaults") {
  const Files files;
  const ExperimentFile file = files.read(
      "input:\n  generate: bay\n  parameters: {resolution: 500, seed: 7}\n"
      "bounds:\n  triangles: 1e5\n"
      "cluster:\n  groups:\n    - {name: old, ranks: 2, speed: 110e3}\n    - {ranks: 1}\n"
      "run:\n  order: largest\n");
  REQUIRE(file.points.size() == 1);
  const Experiment& e = file.points[0].experiment;
  CHECK(e.name == "test");
  CHECK(e.generator_parameters == std::map<std::string, std::string>{{"resolution", "500"}, {"seed", "7"}});
  CHECK(e.triangles == 1e5);
  CHECK(e.angle == 20);
  CHECK(e.order == "largest");
  REQUIRE(e.groups.size() == 2);
  CHECK(e.groups[0].name == "old");
  CHECK(e.groups[0].speed == 110e3);
  CHECK(e.groups[1].speed == 0);
  CHECK(ranks_of(cluster_of(e)) == 3);
}

TEST_CASE("files are relative to the experiment's, and those of settings are not") {
  const Files files;
  const std::string yaml = "input: {file: in/a.poly}\ncluster: {ranks: 1}\n";
  CHECK(files.read(yaml).base.input_file == files.folder() + "/in/a.poly");
  CHECK(files.read(yaml, {"input.file=b.poly"}).base.input_file == "b.poly");
}

TEST_CASE("sweeps are all combinations, the last key fastest") {
  const Files files;
  const ExperimentFile file = files.read(
      "input: {generate: pipe}\n"
      "sweep:\n  cluster.ranks: [2, 4]\n  input.parameters.channels: [4, 5, 6]\n");
  REQUIRE(file.points.size() == 6);
  CHECK(file.points[1].experiment.ranks == 2);
  CHECK(file.points[1].experiment.generator_parameters.at("channels") == "5");
  CHECK(file.points[3].experiment.ranks == 4);
  CHECK(file.points[3].experiment.generator_parameters.at("channels") == "4");
  CHECK(file.points[5].values ==
        std::vector<std::pair<std::string, Json>>{{"cluster.ranks", 4}, {"input.parameters.channels", "6"}});
}

TEST_CASE("settings win over the file and its sweeps") {
  const Files files;
  const std::string yaml =
      "input: {generate: pipe}\ncluster: {ranks: 3}\nsweep: {cluster.ranks: [2, 4], run.aggregation: [1, 8]}\n";
  CHECK(files.read(yaml).points.size() == 4);
  const ExperimentFile one = files.read(yaml, {"cluster.ranks=5"});
  REQUIRE(one.points.size() == 2);
  CHECK(one.points[1].experiment.ranks == 5);
  CHECK(files.read(yaml, {"cluster.ranks=[1, 2, 3]"}).points.size() == 6);
  CHECK(files.read(kLeast, {"cluster.groups=[{ranks: 4}]", "cluster.ranks=0"}).base.groups.size() == 1);
  // A text with what YAML takes for a table's colon.
  CHECK(files.read(kLeast, {"sizing.size=x < 1 ? 0.1 : 0.2"}).base.size_expression == "x < 1 ? 0.1 : 0.2");
}

TEST_CASE("what is wrong is told with its place and what was probably meant") {
  CHECK(message_for("input:\n  fil: a.poly\n") ==
        "test.yaml:2:3: unknown key 'input.fil'; the nearest one is 'input.file'");
  CHECK(message_for("clutser: {ranks: 2}\n") == "test.yaml:1:1: unknown key 'clutser'; the nearest one is 'cluster'");
  CHECK(message_for("bounds: {angle: steep}\n") == "test.yaml:1:17: 'bounds.angle' is 'steep'; give a number");
  CHECK(message_for("bounds: {angle: 35}\n") == "test.yaml:1:17: 'bounds.angle' is 35; it can be at most 34");
  CHECK(message_for("cluster:\n  bandwidth: 0\n") == "test.yaml:2:14: 'cluster.bandwidth' is 0; it must be above 0");
  CHECK(message_for("cluster: {ranks: 2.5}\n") == "test.yaml:1:18: 'cluster.ranks' is 2.5; give a whole number");
  CHECK(message_for("run: {order: largets}\n") ==
        "test.yaml:1:14: 'run.order' is 'largets'; the nearest that it can be is 'largest'");
  CHECK(message_for("pictures: yes\n") == "test.yaml:1:11: 'pictures' is 'yes'; it is either true or false");
  CHECK(message_for("cluster:\n  groups:\n    - {rank: 2}\n") ==
        "test.yaml:3:8: 'cluster.groups' knows no 'rank'; the nearest one is 'ranks'");
  CHECK(message_for("cluster: {ranks: 2}\ncluster: {latency: 1}\n") ==
        "test.yaml:2:1: 'cluster' is given twice; join the two");
  CHECK(message_for("bounds: {angle: 20, angle: 21}\n") ==
        "test.yaml:1:21: 'bounds.angle' is given twice; remove one of them");
  CHECK(message_for("bounds: 3\n") == "test.yaml:1:9: 'bounds' has no single value; give its keys, indented, below");
  CHECK(message_for("seed:\n").find("'seed' has no value") != std::string::npos);
  CHECK(message_for("- 1\n").find("test.yaml:1:1: not a list of 'key: value' lines") == 0);
  CHECK(message_for("input: [\n").find("this is not YAML") != std::string::npos);
  CHECK(message_for("sweep: {cluster.rank: [1]}\n").find("the nearest one is 'cluster.ranks'") != std::string::npos);
  CHECK(message_for("sweep: {cluster.ranks: 1}\n").find("has no list of values") != std::string::npos);
  CHECK(message_for("sweep: {cluster.ranks: [1, many]}\n") ==
        "test.yaml:1:28: 'cluster.ranks' is 'many'; give a number");
  CHECK(message_for(kLeast, {"bounds.angel=3"}) ==
        "--set bounds.angel=3: unknown key 'bounds.angel'; the nearest one is 'bounds.angle'");
  CHECK(message_for(kLeast, {"seed"}) == "--set seed: no value; write --set key=value");
}

TEST_CASE("what cannot be together is told where one of them is given") {
  CHECK(message_for("cluster: {ranks: 2}\n") ==
        "test.yaml: 'input.file': no domain is given; name a file with input.file, or what to generate with "
        "input.generate");
  CHECK(message_for("input: {generate: pipe}\n").find("'cluster.ranks': a cluster without ranks") != std::string::npos);
  CHECK(message_for("input:\n  generate: pip\ncluster: {ranks: 2}\n")
            .find("test.yaml:2:13: 'input.generate': no input") == 0);
  CHECK(message_for("input: {generate: pipe, parameters: {chanels: 3}}\ncluster: {ranks: 2}\n")
            .find("the nearest one is 'channels'") != std::string::npos);
  CHECK(message_for(std::string(kLeast) + "bounds:\n  area: 1\n  triangles: 5\n").find("test.yaml:5:14: ") == 0);
  CHECK(message_for(std::string(kLeast) + "bounds: {area: 1}\nsweep: {bounds.triangles: [0, 100]}\n")
            .find("'bounds.triangles': the size of triangles is asked for twice") != std::string::npos);
}

TEST_CASE("a list of numbers is one value, and lists of lists are swept over") {
  const Files files;
  CHECK(files.read(std::string(kLeast), {"cluster.drag=[1, 0.5]"}).base.drag == std::vector<double>{1, 0.5});
  CHECK(files.read(std::string(kLeast), {"cluster.drag=[]"}).base.drag.empty());
  const ExperimentFile swept = files.read(kLeast, {"cluster.drag=[[1, 1], [1, 0.25]]"});
  REQUIRE(swept.points.size() == 2);
  CHECK(swept.points[1].experiment.drag == std::vector<double>{1, 0.25});
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 2, drag: [1, slow]}\n") ==
        "test.yaml:2:31: 'cluster.drag' is 'slow'; give a number");
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 2, drag: 0.5}\n").find("'cluster.drag' is no list") !=
        std::string::npos);
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 2, drag: [1, 0]}\n").find("at least 0.01") !=
        std::string::npos);
  CHECK(message_for("input: {generate: pipe}\ncluster: {ranks: 3, drag: [1, 1]}\n").find("test.yaml:2:27: ") == 0);
}

TEST_CASE("a parameter that names a policy is that policy's alone") {
  const Files files;
  const ExperimentFile file = files.read(kLeast, {"balance.parameters={zoltan.method: rcb, greedy.tolerance: 0.1}",
                                                  "balance.policy=[none, zoltan, greedy]"});
  REQUIRE(file.points.size() == 3);
  const auto parameters = [&](std::size_t point) { return parameters_of_policy(file.points[point].experiment); };
  CHECK(parameters(0).empty());
  CHECK(parameters(1) == std::map<std::string, std::string>{{"method", "rcb"}});
  CHECK(parameters(2) == std::map<std::string, std::string>{{"tolerance", "0.1"}});
  CHECK(message_for(kLeast, {"balance.parameters={zoltn.method: rcb}"}).find("the nearest one is 'zoltan'") !=
        std::string::npos);
  CHECK(message_for(kLeast, {"balance.policy=zoltan", "balance.parameters={zoltan.methd: rcb}"}).find("methd") !=
        std::string::npos);
}

TEST_CASE("processes that do not fit an experiment are refused where it says what it needs") {
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

TEST_CASE("an experiment in full reads back as itself") {
  const Files files;
  const ExperimentFile file = files.read(
      "name: \"odd: name, #1\"\ninput: {generate: holes, parameters: {columns: 3}}\n"
      "sizing: {size: \"0.1 + 0.05 * hypot(x, y)\", min: 1e-3}\n"
      "cluster:\n  bandwidth: 12.5e6\n  groups: [{name: \"a b\", ranks: 3, speed: 1.5e5}]\n"
      "sweep: {run.order: [given, backlog], decomposition.skew: [0, 0.5]}\n");
  const std::string text = experiment_text(file);
  const ExperimentFile again = files.read(text);
  CHECK(experiment_text(again) == text);
  REQUIRE(again.points.size() == file.points.size());
  for (std::size_t i = 0; i < again.points.size(); ++i) {
    CHECK(again.points[i].values == file.points[i].values);
    CHECK(experiment_json(again.points[i].experiment) == experiment_json(file.points[i].experiment));
  }
}

TEST_CASE("an experiment in full finds its files from any folder") {
  const Files files, elsewhere;
  const ExperimentFile file = files.read("input: {file: in/a.poly}\ncluster: {ranks: 1}\n",
                                         {"decomposition.file=d.txt", "sizing.background=[b.vtu, c.vtu]"});
  const ExperimentFile again = elsewhere.read(experiment_text(file));
  const auto here = [](const char* name) { return (std::filesystem::current_path() / name).string(); };
  REQUIRE(again.points.size() == 2);
  const Experiment& e = again.points[1].experiment;
  CHECK(e.input_file == files.folder() + "/in/a.poly");
  CHECK(e.decomposition_file == here("d.txt"));
  CHECK(e.size_background == here("c.vtu"));
}

TEST_CASE("every key has a default that it accepts, and is stored where it is loaded from") {
  const Files files;
  for (const Key& key : keys()) {
    CAPTURE(key.name);
    CHECK(!key.help.empty());
    CHECK(find_key(key.name).key == &key);
    CHECK(key.load(Experiment{}) == key.standard);
    if (key.name.starts_with("input.") || key.name == "cluster.ranks") continue;
    const ExperimentFile file = files.read(kLeast, {key.name + "=" + value_text(key.standard)});
    CHECK(key.load(file.base) == key.standard);
  }
}

TEST_CASE("the schema knows every key, and the documents show them as they are") {
  const Json schema = Json::parse(json_schema());
  for (const Key& key : keys()) {
    CAPTURE(key.name);
    Json at = schema;
    std::istringstream words(key.name);
    for (std::string word; std::getline(words, word, '.');) at = at.at("properties").at(word);
    CHECK(at.at("description") == key.help);
    CHECK(schema.at("properties").at("sweep").at("properties").contains(key.name));
  }
  const std::string document = read_file(DRIFTMESH_SOURCE_DIR "/docs/experiments.md");
  CHECK_MESSAGE(document.find(keys_table()) != std::string::npos,
                "docs/experiments.md needs the table that driftmesh config --keys prints");
}

TEST_CASE("a prepared run has about the triangles that were asked for") {
  const Files files;
  const auto prepared = [&](const std::vector<std::string>& settings, std::size_t ranks) {
    return prepare(files.read(kLeast, settings).base, std::vector<double>(ranks, 1.0));
  };
  CHECK(prepared({"bounds.triangles=1e5"}, 2).forecast == doctest::Approx(1e5).epsilon(0.1));
  CHECK(prepared({"bounds.triangles-per-rank=2e4"}, 3).forecast == doctest::Approx(6e4).epsilon(0.1));
  CHECK(prepared({"decomposition.subdomains-per-rank=7"}, 3).plan.decomposition.size() == 21);
  const Prepared blocks = prepared({"mapping.method=round-robin", "decomposition.subdomains=10"}, 4);
  CHECK(blocks.plan.owners == std::vector<protocol::Rank>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1});
}

TEST_CASE("every shipped experiment is valid") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DRIFTMESH_SOURCE_DIR "/configs")) {
    CAPTURE(entry.path().string());
    ++files;
    CHECK_NOTHROW(static_cast<void>(read_experiment(entry.path().string(), {})));
  }
  CHECK(files > 0);
}
