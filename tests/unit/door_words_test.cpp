#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "api/library_request.hpp"
#include "app/request_line.hpp"
#include "base/failure.hpp"
#include "config/experiment.hpp"
#include "driftmesh/driftmesh.hpp"
#include "job/check.hpp"
#include "job/files.hpp"
#include "job/keys.hpp"
#include "job/limits.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

// One error has other words behind each door: the command line, experiments, the library and Python.

using namespace driftmesh;
using namespace driftmesh::testing;
using job::Key;
using job::Request;

namespace {

struct Door {
  const char* name;
  job::EntryPoints entry_points;
  Words words;
};

const std::vector<Door>& doors() {
  static const std::vector<Door> all{
      {"command line", job::kMesh, job::words_of(job::kMesh)},
      {"experiment", job::kExperiment, job::words_of(job::kExperiment)},
      {"library", job::kLibrary, words_of_library},
      {"Python", job::kLibrary, [](const std::string& key) { return library_name(key).member; }}};
  return all;
}

/// What a door calls all keys that it has. Functions are the library's only.
std::set<std::string> names_behind(const Door& door) {
  std::set<std::string> names;
  for (const Key& key : job::keys())
    if ((key.entry_points & door.entry_points) != 0) names.insert(door.words(key.name));
  if (door.entry_points == job::kLibrary)
    for (const char* own : {"sizing.size", "progress", "warning", "balance.own", "subdomains.given", "cluster.ranks",
                            "cluster.speed", "cluster.rank-speeds"})
      names.insert(door.words(own));
  return names;
}

/// Words that look like the names of settings: "--area", "bounds.area", "max_area".
std::set<std::string> settings_in(const std::string& text) {
  constexpr const char* kOfNames = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_.:-";
  std::set<std::string> found;
  for (std::size_t begin = 0; (begin = text.find_first_of(kOfNames, begin)) != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_not_of(kOfNames, begin), text.size());
    std::string word = text.substr(begin, end - begin);
    while (!word.empty() && (word.back() == ':' || word.back() == '.')) word.pop_back();
    if (word.starts_with("--") || word.find_first_of("._:") != std::string::npos) found.insert(word);
    begin = end;
  }
  return found;
}

void check_words(const Door& door, const std::string& message) {
  CAPTURE(message);
  INFO(std::string(door.name));
  const std::set<std::string> own = names_behind(door);
  for (const Door& other : doors())
    for (const std::string& foreign : names_behind(other))
      if (!own.contains(foreign)) CHECK_MESSAGE(!settings_in(message).contains(foreign), foreign);
  CHECK(message.find_first_of("{}") == std::string::npos);
}

/// A value, in words, that the key must refuse; empty if it takes all.
std::string bad_value(const Key& key) {
  if (key.kind == job::KeyInfo::Kind::kChoice) return "nonsense";
  if (key.kind == job::KeyInfo::Kind::kFlag) return "perhaps";
  if (key.kind != job::KeyInfo::Kind::kNumber && key.kind != job::KeyInfo::Kind::kInteger &&
      key.kind != job::KeyInfo::Kind::kNumbers)
    return "";
  if (std::isfinite(key.least)) return job::shortest_text(key.least - 1);
  return std::isfinite(key.most) ? job::shortest_text(key.most + 1) : "";
}

std::optional<KeyError> refusal(const Key& key) {
  try {
    static_cast<void>(job::read_value(key, bad_value(key)));
  } catch (const KeyError& error) {
    return error;
  }
  return {};
}

/// The options of the library for a request.
MeshOptions options_of(Request request) {
  MeshOptions options;
  visit_options(options, request, [](const char*, const char*, auto& member, const auto& place) { member = place; });
  return options;
}

std::string refusal_of_command_line(const Key& key) {
  app::GivenKeys given;
  given.items.push_back({&key, bad_value(key)});
  Request request;
  return error_text<std::exception>([&] { app::in_words_of_options(given, {}, [&] { given.apply(request); }); });
}

std::string refusal_of_experiment(const Key& key, const std::string& file) {
  const std::string value = key.kind == job::KeyInfo::Kind::kNumbers ? "[[" + bad_value(key) + "]]" : bad_value(key);
  return error_text([&] { static_cast<void>(config::read_experiment(file, {key.name + "=" + value})); });
}

/// Bad combinations, and the keys that their messages name.
struct Combination {
  std::function<void(Request&)> make;
  job::PlaceKind place;
  std::vector<const char*> named;
};

const std::vector<Combination>& combinations() {
  static const std::vector<Combination> all{
      {[](Request& r) { r.bounds.area = r.bounds.triangles = 100; },
       job::kOnePiece,
       {"bounds.triangles", "bounds.area"}},
      {[](Request& r) { r.sizing.gradation = 1; },
       job::kOnePiece,
       {"sizing.gradation", "sizing.size", "sizing.background"}},
      {[](Request& r) { r.sizing.longest = 1, r.sizing.shortest = 2; }, job::kOnePiece, {"sizing.min", "sizing.max"}},
      {[](Request& r) { r.sizing.shortest = 2; },
       job::kOnePiece,
       {"sizing.min", "sizing.size", "sizing.background", "sizing.max"}},
      {[](Request& r) { r.run.slice = 5; }, job::kOnePiece, {"run.slice", "decomposition.subdomains"}},
      {[](Request& r) { r.mapping.speeds = {1}; }, job::kSubdomains, {"mapping.speeds"}},
      {[](Request& r) { r.run.scratch = "x", r.decomposition.subdomains = 1; },
       job::kOnePiece,
       {"run.scratch", "decomposition.subdomains"}},
      {[](Request& r) { r.run.scratch = "x", r.limits.keep_incomplete = true; },
       job::kOnePiece,
       {"run.scratch", "limits.keep-incomplete"}},
      {[](Request& r) { r.output.depth = "depth"; }, job::kOnePiece, {"output.depth", "input.rasters"}},
      {[](Request& r) {
         r.input.rasters = {{"depth", "a.asc"}};
       },
       job::kOnePiece,
       {"input.rasters", "sizing.size", "output.depth"}},
      {[](Request& r) { r.input.file = "a.poly", r.input.generator = "pipe"; },
       job::kOnePiece,
       {"input.generate", "input.file"}},
      {[](Request& r) {
         r.input.parameters = {{"seed", "1"}};
       },
       job::kOnePiece,
       {"input.parameters", "input.generate"}},
      {[](Request& r) { r.run.method = job::Method::kDecoupled, r.run.presplit = Presplit::kOff; },
       job::kSubdomains,
       {"run.presplit"}},
      {[](Request& r) { r.run.method = job::Method::kDecoupled, r.sizing.expression = "1"; },
       job::kSubdomains,
       {"run.method", "bounds.area", "bounds.triangles"}},
      {[](Request& r) { r.cluster.ranks = 0; },
       job::kSimulated,
       {"cluster.ranks", "cluster.groups", "cluster.rank-speeds"}}};
  return all;
}

/// The errors that the tests above do not reach without a machine without memory, or a broken file.
std::vector<KeyText> other_texts() {
  std::vector<KeyText> texts{out_of_memory()};
  const job::Limits limits{.triangles = 1000, .in_memory = 500};
  for (const bool by_memory : {false, true})
    for (const bool kept : {false, true}) texts.push_back(job::stopped_message(limits, by_memory, 1000, kept));
  const auto thrown = [&](const auto& work) {
    try {
      work();
    } catch (const Error& error) {
      texts.push_back(text_of(error));
    }
  };
  for (const bool may_keep : {false, true}) thrown([&] { job::check_forecast(limits, 1e6, may_keep); });
  thrown([&] { job::check_capacity(1e12, 0, job::kMesh); });
  return texts;
}

/// Everything that any door calls a key, as a user may write it.
std::set<std::string> all_names() {
  std::set<std::string> names{"{bounds.area}", "{}", "{"};
  for (const Door& door : doors()) names.merge(names_behind(door));
  return names;
}

}  // namespace

TEST_CASE("a bad value of each key is told behind each door that has the key, in its words") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "plain.yaml").string();
  std::ofstream(file) << "input: {generate: pipe}\nbounds: {area: 1}\ncluster: {ranks: 2}\n";
  int checked = 0;
  for (const Key& key : job::keys()) {
    const std::optional<KeyError> error = bad_value(key).empty() ? std::nullopt : refusal(key);
    if (!error) continue;
    CAPTURE(key.name);
    for (const Door& door : doors()) {
      if ((key.entry_points & door.entry_points) == 0) continue;
      const std::string message = error->text().in(door.words);
      CHECK(message.starts_with(door.words(key.name) + " is "));
      check_words(door, message);
      ++checked;
    }
    if ((key.entry_points & job::kMesh) != 0 && key.kind != job::KeyInfo::Kind::kFlag)
      CHECK(refusal_of_command_line(key) == error->text().in(doors()[0].words));
    if ((key.entry_points & job::kExperiment) != 0) {
      const std::string said = refusal_of_experiment(key, file);
      CHECK_MESSAGE(said.find("'" + key.name + "' is ") != std::string::npos, said);
    }
    const bool is_number = key.kind == job::KeyInfo::Kind::kNumber || key.kind == job::KeyInfo::Kind::kInteger ||
                           key.kind == job::KeyInfo::Kind::kNumbers;
    if ((key.entry_points & job::kLibrary) != 0 && is_number) {
      Request request;
      const double bad = std::isfinite(key.least) ? key.least - 1 : key.most + 1;
      if (key.kind == job::KeyInfo::Kind::kNumbers)
        key.store(request, std::vector<double>{bad});
      else
        key.store(request, key.kind == job::KeyInfo::Kind::kNumber ? job::Value(bad)
                                                                   : job::Value(static_cast<std::int64_t>(bad)));
      const auto call = [&] { static_cast<void>(mesh(generate_rectangle_hole({}), options_of(request))); };
      // 0 stands for the default in the options of the library.
      if (key.name != "limits.max-triangles") CHECK(error_text(call) == error->text().in(words_of_library));
    }
  }
  CHECK(checked > 100);
}

TEST_CASE("values that cannot be combined are told in the words of each door") {
  for (const Combination& combination : combinations()) {
    Request request;
    combination.make(request);
    std::optional<KeyError> error;
    try {
      job::check(request, combination.place);
    } catch (const KeyError& refused) {
      error = refused;
    }
    CAPTURE(std::string(combination.named.front()));
    REQUIRE(error);
    CHECK(error->key() == combination.named.front());
    for (const Door& door : doors()) {
      const auto has = [&](const char* key) {
        return (job::find_key(key).key->entry_points & door.entry_points) != 0 || std::string(key) == "sizing.size";
      };
      if (!std::ranges::all_of(combination.named, has)) continue;
      const std::string message = error->text().in(door.words);
      for (const char* key : combination.named)
        CHECK_MESSAGE(settings_in(message + " " + door.words(key)).size() == settings_in(message).size(), message);
      check_words(door, message);
    }
  }
}

TEST_CASE("limits are told in the words of each door") {
  for (const KeyText& text : other_texts())
    for (const Door& door : doors()) {
      const std::string message = text.in(door.words);
      const bool keeps = message.find(door.words("limits.keep-incomplete")) != std::string::npos;
      if (keeps && door.entry_points == job::kLibrary) continue;  // which never keeps part of a mesh
      CHECK(!settings_in(message).empty());
      check_words(door, message);
    }
}

TEST_CASE("no door changes what users wrote") {
  for (const std::string& written : all_names()) {
    const KeyError error("bounds.angle", written, KeyText::of("not {} but {bounds.area}", written));
    const auto expected = [&](const Words& words) {
      return words("bounds.angle") + " " + written + "; not " + written + " but " + words("bounds.area");
    };
    for (const Door& door : doors()) CHECK(error.text().in(door.words) == expected(door.words));
    const auto fail = [&] { throw error; };
    CHECK(error_text<std::exception>([&] { app::in_words_of_options({}, {}, fail); }) == expected(doors()[0].words));
    CHECK(error_text([&] { in_words_of_library(fail); }) == expected(words_of_library));
    const config::SourcePlaces places{{"bounds.angle", "a.yaml:1:2"}};
    const std::string in_file = config::placed(error, places, "").what();
    CHECK(in_file == "a.yaml:1:2: 'bounds.angle' " + written + "; not " + written + " but bounds.area");
  }
}

TEST_CASE("numbers in texts have the digits that they need") {
  CHECK(KeyText::of("{bounds.area} is {} of {}, not {}", 1e-9, 3, 0.1).in(full_name) ==
        "bounds.area is 1e-09 of 3, not 0.1");
}

TEST_CASE("an error keeps its kind, its place and its parts behind a door, and on its way to other ranks") {
  const KeyText text = KeyText::of("{} {bounds.area} {}", "--area {bounds.area}", 5);
  const auto sent = [](const std::exception_ptr& error) {
    ByteWriter writer;
    failure_of(error).write(writer);
    const Bytes bytes = writer.take();
    ByteReader reader(bytes);
    return Failure::read(reader);
  };
  const auto words_after = [&](const auto& error, const auto& kind) {
    using Expected = std::decay_t<decltype(kind)>;
    try {
      in_words_of_library([&] { raise(sent(std::make_exception_ptr(error))); });
    } catch (const Expected& received) {
      CHECK(text_of(received) == text_of(error));
      return std::string(received.what());
    }
    return std::string("another kind");
  };
  const std::string expected = "--area {bounds.area} MeshOptions::max_area 5";
  CHECK(words_after(Keyed<LimitError>(text), LimitError("")) == expected);
  CHECK(words_after(Keyed<FileError>(text), FileError("")) == expected);
  CHECK(words_after(Keyed<Cancelled>(text), Cancelled("")) == expected);
  CHECK(words_after(Keyed<Error>(text), Error("")) == expected);
  CHECK(words_after(Keyed<InputError>(text), InputError("")) == expected);
  CHECK(words_after(KeyError("seed", text, "remove {seed}"), Error("")) ==
        "MeshOptions::subdomains.seed " + expected + "; remove MeshOptions::subdomains.seed");
  try {
    in_words_of_library([&] { throw Keyed<InputError>(SourcePlace{"a.poly", 3}, "is bad", "see {bounds.area}"); });
    FAIL("nothing is thrown");
  } catch (const InputError& error) {
    CHECK(error.place().file == "a.poly");
    CHECK(error.place().line == 3);
    CHECK(std::string(error.what()) == "a.poly:3: is bad; see MeshOptions::max_area");
  }
}
