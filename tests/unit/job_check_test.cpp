#include <doctest/doctest.h>

#include <functional>
#include <set>
#include <string>

#include "job/check.hpp"
#include "job/keys.hpp"

using namespace driftmesh;
using namespace driftmesh::job;

namespace {

/// The key that is rejected at a place, or "" if none is.
std::string refused(PlaceKind place, const std::function<void(Request&)>& change) {
  Request request;
  if (place == kSimulated) request.cluster.ranks = 4;
  change(request);
  try {
    check(request, place);
  } catch (const KeyError& error) {
    CHECK(!error.next().empty());
    return error.key();
  }
  return "";
}

}  // namespace

TEST_CASE("the defaults are valid everywhere") {
  for (const PlaceKind place : {kOnePiece, job::kSubdomains, kRanks, kSimulated})
    CHECK(refused(place, [](Request&) {}).empty());
}

TEST_CASE("keys that do not apply are rejected, never ignored") {
  const auto policy = [](Request& r) { r.balance.policy = "stealing"; };
  CHECK(refused(kOnePiece, policy) == "balance.policy");
  CHECK(refused(job::kSubdomains, policy) == "balance.policy");
  CHECK(refused(kRanks, policy).empty());
  CHECK(refused(kSimulated, policy).empty());
  CHECK(refused(kOnePiece, [](Request& r) { r.mapping.speeds = {1, 2, 3}; }) == "mapping.speeds");
  CHECK(refused(kOnePiece, [](Request& r) { r.balance.parameters = {{"foo", "one"}}; }) == "balance.parameters");
  CHECK(refused(kOnePiece, [](Request& r) { r.run.sleep = true; }) == "run.sleep");
  CHECK(refused(job::kSubdomains, [](Request& r) { r.run.sleep = true; }).empty());
  CHECK(refused(kRanks, [](Request& r) { r.limits.keep_incomplete = true; }) == "limits.keep-incomplete");
  CHECK(refused(kRanks, [](Request& r) { r.cluster.latency = 1; }).empty());  // a file may serve both kinds of ranks
  CHECK(refused(kOnePiece, [](Request& r) { r.cluster.latency = 1; }) == "cluster.latency");
  CHECK(refused(kRanks, [](Request& r) { r.cluster.groups = {{"a", 2, 1e6}}; }) == "cluster.groups");
}

TEST_CASE("every key that does not apply at a place is rejected there") {
  for (const Key& key : keys())
    for (const PlaceKind place : {kOnePiece, job::kSubdomains, kRanks, kSimulated}) {
      const auto* const number = std::get_if<double>(&key.standard);
      if ((key.places & place) != 0 || number == nullptr) continue;
      CAPTURE(key.name);
      const double other = *number + 0.01;
      CHECK(refused(place, [&](Request& r) { key.store(r, other); }) == key.name);
    }
}

TEST_CASE("values set by a program have the ranges of the command line") {
  CHECK(refused(kOnePiece, [](Request& r) { r.bounds.angle = 35; }) == "bounds.angle");
  CHECK(refused(job::kSubdomains, [](Request& r) { r.decomposition.skew = 5; }) == "decomposition.skew");
  CHECK(refused(kRanks, [](Request& r) { r.cluster.drag = {1, 0}; }) == "cluster.drag");
}

TEST_CASE("contradictory values are rejected") {
  CHECK(refused(kOnePiece, [](Request& r) { r.bounds.area = r.bounds.triangles = 5; }) == "bounds.triangles");
  CHECK(refused(kOnePiece, [](Request& r) { r.sizing.gradation = 0.2; }) == "sizing.gradation");
  CHECK(refused(kOnePiece, [](Request& r) { r.sizing.shortest = 2, r.sizing.longest = 1; }) == "sizing.min");
  CHECK(refused(kOnePiece, [](Request& r) { r.sizing.shortest = 2; }) == "sizing.min");
  CHECK(refused(kOnePiece, [](Request& r) { r.input.file = r.input.generator = "pipe"; }) == "input.generate");
  CHECK(refused(kOnePiece, [](Request& r) { r.input.generator = "pip"; }) == "input.generate");
  CHECK(refused(kOnePiece, [](Request& r) { r.input.parameters = {{"x", "1"}}; }) == "input.parameters");
  CHECK(refused(job::kSubdomains, [](Request& r) {
          r.decomposition.file = "a.parts", r.decomposition.subdomains = 3;
        }) == "decomposition.file");
  CHECK(refused(kRanks, [](Request& r) { r.mapping.speeds = {1}, r.mapping.by_speed = true; }) == "mapping.by-speed");
  CHECK(refused(kSimulated, [](Request& r) { r.cluster.ranks = 0; }) == "cluster.ranks");
  CHECK(refused(kSimulated, [](Request& r) { r.cluster.drag = {1, 1}; }) == "cluster.drag");
  CHECK(refused(kSimulated, [](Request& r) { r.cluster.rank_speeds = {1e6, 2e6}; }) == "cluster.rank-speeds");
}

TEST_CASE("what a run in rounds cannot have is rejected, and so is what only it can have") {
  const auto refused_in_rounds = [](PlaceKind place, auto&& change) {
    return refused(place, [&](Request& r) {
      r.run.method = Method::kRounds;
      change(r);
    });
  };
  CHECK(refused_in_rounds(kSimulated, [](Request& r) { r.cluster.ranks = 2; }) == "run.method");
  CHECK(refused_in_rounds(kRanks, [](Request&) {}) == "run.method");
  CHECK(refused_in_rounds(job::kSubdomains, [](Request& r) { r.decomposition.subdomains = 1; }) == "run.method");
  CHECK(refused_in_rounds(job::kSubdomains, [](Request& r) { r.mapping.speeds = {1, 2}; }) == "mapping.speeds");
  CHECK(refused_in_rounds(job::kSubdomains, [](Request& r) { r.run.checkpoint = "-"; }) == "run.checkpoint");
  CHECK(refused_in_rounds(job::kSubdomains, [](Request& r) { r.run.every = 5; }) == "run.every");
  CHECK(refused(job::kSubdomains, [](Request& r) { r.run.checkpoint = "a.kept"; }) == "run.checkpoint");
  CHECK(refused(job::kSubdomains, [](Request& r) { r.run.resume = "a.kept"; }) == "run.resume");
}

TEST_CASE("options of some formats need a file of one of them") {
  const auto refused_with = [](const std::string& file, const std::function<void(Request::Output&)>& change) {
    return refused(kOnePiece, [&](Request& r) {
      if (!file.empty()) r.output.meshes = {"a.su2", file};
      change(r.output);
    });
  };
  const auto ascii = [](Request::Output& output) { output.ascii = true; };
  const auto ghosts = [](Request::Output& output) { output.ghost_layer = true; };
  const auto open = [](Request::Output& output) { output.open_boundary = {2}; };
  const auto long_ones = [](Request::Output& output) { output.open_from = 5; };
  for (const char* file : {"", "b.vtu"}) {
    CHECK(refused_with(file, ascii) == "output.ascii");
    CHECK(refused_with(file, ghosts) == "output.ghost-layer");
    CHECK(refused_with(file, open) == "output.open-boundary");
    CHECK(refused_with(file, long_ones) == "output.open-from");
  }
  CHECK(refused_with("b.msh", ascii).empty());
  CHECK(refused_with("b.pvtu", ghosts).empty());
  for (const char* file : {"b.14", "b.grd", "b.gr3"}) {
    CHECK(refused_with(file, open).empty());
    CHECK(refused_with(file, long_ones).empty());
  }
}

TEST_CASE("a list of rasters names a file on both sides of each comma") {
  const auto refused_list = [](const char* files) {
    return refused(kOnePiece, [&](Request& r) {
      r.input.rasters = {{"d", files}};
      r.sizing.expression = "d";
    });
  };
  CHECK(refused_list("a.asc,b.asc").empty());
  for (const char* files : {"a.asc,", ",a.asc", "a.asc,,b.asc", ","}) CHECK(refused_list(files) == "input.rasters");
}

TEST_CASE("what somebody has set must serve, even where it is the default") {
  const auto refused_given = [](const std::set<std::string>& given, const std::function<void(Request&)>& change = {}) {
    Request request;
    if (change) change(request);
    try {
      check_given(request, given);
    } catch (const KeyError& error) {
      return error.key();
    }
    return std::string();
  };
  CHECK(refused_given({}).empty());
  for (const std::string key : {"sizing.courant", "sizing.courant-speed", "sizing.courant-length"}) {
    CHECK(refused_given({key}) == key);
    CHECK(refused_given({key}, [](Request& r) { r.sizing.courant_step = 5; }).empty());
  }
  CHECK(refused_given({"run.every"}) == "run.every");
  CHECK(refused_given({"run.every"}, [](Request& r) { r.run.checkpoint = "a.kept"; }).empty());
  CHECK(refused(kOnePiece, [](Request& r) { r.run.every = 5; }) == "run.every");
}

TEST_CASE("the place of a mesh follows from the entry point and the request") {
  Request request;
  CHECK(place_of(request, kMesh, false) == kOnePiece);
  CHECK(place_of(request, kMesh, true) == kRanks);
  request.run.method = Method::kRounds;
  CHECK(place_of(request, kMesh, false) == job::kSubdomains);
  request.run.method = Method::kCoupled;
  request.decomposition.subdomains = 4;
  CHECK(place_of(request, kMesh, false) == job::kSubdomains);
  CHECK(place_of(request, kExperiment, true) == kSimulated);
  request.cluster.kind = ClusterKind::kReal;
  CHECK(place_of(request, kExperiment, false) == kRanks);
}

TEST_CASE("lists for ranks have a value for each") {
  Request request;
  request.mapping.speeds = {1, 2, 3};
  CHECK_THROWS_AS(check_ranks(request, kRanks, 2), KeyError);
  CHECK_NOTHROW(check_ranks(request, kRanks, 3));
}
