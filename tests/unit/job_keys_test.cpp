#include <doctest/doctest.h>

#include <limits>
#include <set>
#include <string>

#include "job/keys.hpp"

using namespace driftmesh;
using namespace driftmesh::job;

namespace {

const KeyInfo& key(const char* name) {
  return *find_key(name).key;
}

/// The number that a key reads from a text, or -1 if the key rejects it.
double number(const char* name, const std::string& text) {
  try {
    const Value value = read_value(key(name), text);
    const auto* whole = std::get_if<std::int64_t>(&value);
    return whole != nullptr ? static_cast<double>(*whole) : value.as<double>();
  } catch (const KeyError&) {
    return -1;
  }
}

std::string refusal(const char* name, const std::string& text) {
  try {
    static_cast<void>(read_value(key(name), text));
  } catch (const KeyError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("every key has a default within its range, and is stored where it is loaded from") {
  for (const Key& k : keys()) {
    CAPTURE(k.name);
    CHECK(!k.help.empty());
    CHECK(k.places != 0);
    CHECK(k.entry_points != 0);
    CHECK(find_key(k.name).key == &k);
    CHECK(k.load(Request{}) == k.standard);
    if (!k.option.empty()) CHECK(find_option(k.option).key == &k);
    if (k.kind == KeyInfo::Kind::kNumber) CHECK_NOTHROW(check_range(k, k.standard.as<double>()));
    if (k.kind == KeyInfo::Kind::kChoice) CHECK_NOTHROW(static_cast<void>(read_value(k, k.standard.as<std::string>())));
  }
}

TEST_CASE("no two keys share a name, an option, a letter or a place in the request") {
  std::set<std::string> names, options;
  std::set<char> letters;
  for (const Key& k : keys()) {
    CHECK(names.insert(k.name).second);
    if (!k.option.empty()) CHECK(options.insert(k.option).second);
    if (k.letter != 0) CHECK(letters.insert(k.letter).second);
  }
  // A value stored through one key does not change any other.
  for (const Key& k : keys()) {
    Request request;
    Value other = k.standard;
    if (auto* number = std::get_if<double>(&other))
      *number += 0.25;
    else if (auto* whole = std::get_if<std::int64_t>(&other))
      *whole += 1;
    else if (auto* flag = std::get_if<bool>(&other))
      *flag = !*flag;
    else
      continue;
    k.store(request, other);
    for (const Key& seen : keys()) CHECK((seen.load(request) != seen.standard) == (&seen == &k));
  }
}

TEST_CASE("numbers accept units everywhere") {
  CHECK(number("bounds.area", "5k") == 5000);
  CHECK(number("bounds.area", "2.5e-3") == 2.5e-3);
  CHECK(number("bounds.triangles", "50M") == 50e6);
  CHECK(number("limits.max-triangles", "0.5G") == 0.5e9);
  CHECK(number("limits.max-memory", "2e6") == 2e6);
  CHECK(number("limits.max-memory", "1.5k") == 1536);
  CHECK(number("limits.max-memory", "0.5") == 1);  // 0 would be no limit
  CHECK(number("limits.max-memory", "3M") == 3 << 20);
  CHECK(number("limits.max-memory", "6GiB") == static_cast<double>(std::int64_t{6} << 30));
  CHECK(number("limits.max-memory", "1tb") == static_cast<double>(std::int64_t{1} << 40));
  for (const std::string bad : {"", "-1", "-1G", "much", "1X", "1 GG", "G", "nan", "inf", "1e30", "1.2.3", "1e999"})
    CHECK_MESSAGE(number("limits.max-memory", bad) == -1, bad);
  for (const std::string bad : {"5kB", "5KiB", "0x10", "5kk"}) CHECK_MESSAGE(number("bounds.area", bad) == -1, bad);
}

TEST_CASE("invalid values of a key are rejected with a message") {
  CHECK(refusal("bounds.angle", "50") ==
        "bounds.angle is 50; it must be at most 34: above that, refinement may not terminate");
  CHECK(refusal("bounds.angle", "-1") == "bounds.angle is -1; it must be at least 0");
  CHECK(refusal("cluster.bandwidth", "0") == "cluster.bandwidth is 0; it must be above 0");
  CHECK(refusal("decomposition.subdomains", "2.5") == "decomposition.subdomains is 2.5; give a whole number");
  CHECK(refusal("run.order", "largets") == "run.order is 'largets'; the nearest valid value is 'largest'");
  CHECK(refusal("run.sleep", "yes") == "run.sleep is 'yes'; it is either true or false");
}

TEST_CASE("the nearest name is one that the entry point knows") {
  CHECK(nearest_key("anlge", kMesh) == "angle");
  CHECK(nearest_key("cluster.latncy", kExperiment) == "cluster.latency");
  CHECK(nearest_key("output.meshs", kExperiment) != "output.meshes");
}

TEST_CASE("values in one line of YAML") {
  CHECK(text_of(Value(0.1)) == "0.1");
  CHECK(text_of(Value(-std::numeric_limits<double>::quiet_NaN())) == "nan");
  CHECK(text_of(Value(std::string("a b"))) == "\"a b\"");
  CHECK(text_of(Value(std::string())) == "\"\"");
  CHECK(text_of(Value(std::vector<double>{1, 0.5})) == "[1, 0.5]");
  CHECK(text_of(Value(std::map<std::string, std::string>{{"a", "b"}})) == "{a: b}");
  CHECK(text_of(Value(std::vector<Record>{{{"ranks", std::int64_t{3}}, {"name", std::string("x")}}})) ==
        "[{ranks: 3, name: x}]");
}
