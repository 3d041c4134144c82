#include "job/checkpoint_file.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

#include "base/key_error.hpp"
#include "distributed/parts_file.hpp"
#include "driftmesh/error.hpp"
#include "job/keys.hpp"
#include "job/value_bytes.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using job::Request;
using testing::error_text;
using testing::mentions;

namespace {

/// Writes a checkpoint of this request, with an empty part.
void write(const std::string& path, const Request& request) {
  OneRank one;
  write_parts(
      path, kCheckpointFile, checkpoint_heads(request, job::RunRecord(), job::Order()), 1, {{SubdomainId{0}, 0}},
      [](SubdomainId) { return Bytes(); }, one);
}

Request asked_to_resume(const std::string& path) {
  Request asked;
  asked.run.resume = path;
  return asked;
}

}  // namespace

TEST_CASE("values of all kinds come back from bytes") {
  std::set<std::size_t> kinds;
  for (const job::Key& key : job::keys()) {
    if (key.kind == job::KeyInfo::Kind::kList) continue;
    ByteWriter writer;
    write_value(writer, key.standard);
    const Bytes bytes = writer.take();
    ByteReader reader(bytes);
    CHECK(job::read_value(reader) == key.standard);
    reader.end();
    kinds.insert(key.standard.index());
  }
  CHECK(kinds.size() >= 6);
  const std::vector<job::Value> some{std::vector<double>{1, -2.5}, std::vector<std::string>{"a", ""},
                                     std::map<std::string, std::string>{{"a", "b"}, {"c", ""}}, true};
  for (const job::Value& value : some) {
    ByteWriter writer;
    write_value(writer, value);
    const Bytes bytes = writer.take();
    ByteReader reader(bytes);
    CHECK(job::read_value(reader) == value);
  }
  const Bytes unknown{std::byte{99}};
  ByteReader reader(unknown);
  CHECK_THROWS_AS(static_cast<void>(job::read_value(reader)), Error);
}

TEST_CASE("what decides the mesh comes from the checkpoint, and all else from who goes on") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run.kept").string();
  Request first;
  first.input.generator = "pipe";
  first.input.parameters = {{"resolution", "40"}};
  first.input.marker_names = {{"1", "wall"}};
  first.bounds.angle = 27;
  first.bounds.area = 0.25;
  first.bounds.region_areas = false;
  first.sizing.expression = "0.1 + x";
  first.decomposition.subdomains = 12;
  first.output.meshes = {"first.vtu"};
  first.limits.max_triangles = 1000;
  first.run.checkpoint = path;
  first.run.threads = 3;
  write(path, first);

  Request asked = asked_to_resume(path);
  asked.output.meshes = {"second.vtu"};
  asked.limits.max_memory = 1 << 30;
  asked.run.threads = 2;
  asked.run.sleep = true;
  const Request resumed = resumed_request(asked, {"output.meshes", "run.threads"});
  for (const job::Key& key : job::keys()) {
    CAPTURE(key.name);
    const bool free =
        key.name.starts_with("output.") || key.name.starts_with("limits.") || key.name.starts_with("run.");
    CHECK((key.load(resumed) == key.load(free ? asked : first)));
  }

  asked.bounds.angle = 27;
  CHECK_NOTHROW((void)resumed_request(asked, {"bounds.angle"}));
  asked.bounds.angle = 20;
  CHECK_NOTHROW((void)resumed_request(asked, {}));
  const auto error = [&](const std::string& key) {
    return error_text<KeyError>([&] { (void)resumed_request(asked, {key}); });
  };
  CHECK(mentions(error("bounds.angle"), {"bounds.angle is 20", "run.kept has 27", "run.resume"}));
  asked.output.depth = "bed";  // values of points
  CHECK(mentions(error("output.depth"), {"output.depth is bed"}));
  asked.sizing.save_tree = "sizes.tree";  // nothing compiles them
  CHECK(mentions(error("sizing.save-tree"), "sizing.save-tree"));
}

TEST_CASE("a file without what a checkpoint has is refused by name") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run.kept").string();
  OneRank one;
  write_parts(
      path, kCheckpointFile, {{kCheckpointFile.head, {}}}, 1, {{SubdomainId{0}, 0}},
      [](SubdomainId) { return Bytes(); }, one);
  CHECK(mentions(error_text([&] { (void)resumed_request(asked_to_resume(path), {}); }), {"run.kept", "settings"}));
  ByteWriter writer;
  writer.text("bounds.unheard-of");
  write_value(writer, job::Value(1.0));
  write_parts(
      path, kCheckpointFile, {{kCheckpointFile.head, {}}, {"settings", writer.take()}}, 1, {{SubdomainId{0}, 0}},
      [](SubdomainId) { return Bytes(); }, one);
  CHECK(mentions(error_text([&] { (void)resumed_request(asked_to_resume(path), {}); }),
                 {"run.kept", "bounds.unheard-of"}));
  job::RunRecord record;
  CHECK(mentions(error_text([&] { (void)resumed_order(asked_to_resume(path), 1, record); }), "run.kept"));
}
