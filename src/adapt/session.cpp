#include "adapt/session.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "adapt/demand.hpp"
#include "adapt/lineage.hpp"
#include "base/in_turns.hpp"
#include "base/stopwatch.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {
namespace {

void require_sound(const AdaptiveOptions& options) {
  const auto require = [](bool sound, const char* name, double value, const char* rule) {
    if (!sound)
      throw Error(std::string("AdaptiveOptions::") + name + " is " + std::to_string(value) + "; it must be " + rule);
  };
  require(options.shortest >= 0, "shortest", options.shortest, "at least 0");
  require(options.longest > 0 && options.longest >= options.shortest, "longest", options.longest,
          "positive, and not below shortest");
  require(options.gradation >= 0, "gradation", options.gradation, "at least 0");
  require(options.coarsening >= 0 && options.coarsening < 1, "coarsening", options.coarsening, "from 0 up to 1");
  require(options.most_triangles >= 0, "most_triangles", options.most_triangles, "at least 0");
}

}  // namespace

Session::Session(Start start, const AdaptiveOptions& options, std::function<void(Mesh&)> finish)
    : plan_(std::move(start.plan)), pslg_(std::move(start.pslg)), options_(options), finish_(std::move(finish)) {
  require_sound(options);
  Parts parts;
  for (const SubdomainId s : ids_of(start.parts)) {
    Part& part = parts.emplace_back();
    part.mesh = std::make_shared<const SubdomainMesh>(std::move(start.parts[s]));
    if (!start.lengths.empty()) part.made_for = std::make_shared<const Lengths>(std::move(start.lengths[s]));
    part.asked = demand_of(part.mesh->mesh, plan_.bounds, part.made_for ? *part.made_for : Lengths()).triangles;
    if (part.asked > 0) part.density = static_cast<double>(part.mesh->mesh.live_triangles()) / part.asked;
  }
  present_ = assemble(plan_.decomposition, pslg_, std::move(parts));
  finish_(present_.piece.mesh);
}

void Session::adapt(std::span<const double> lengths, std::int32_t threads, const Hooks& hooks) {
  advance([&] { return fit_lengths(present_, plan_.bounds, options_, lengths, threads); }, threads, hooks);
}

void Session::adapt(const SizeField& size, std::int32_t threads, const Hooks& hooks) {
  FittedField field(size, options_);
  advance([&] { return fit_field(present_, plan_.bounds, options_, field, threads); }, threads, hooks);
}

void Session::advance(const std::function<Wanted()>& want, std::int32_t threads, const Hooks& hooks) {
  const Stopwatch all;
  AdaptReport report{.generation = report_.generation + 1};
  Stopwatch stage;
  const Wanted wanted = want();
  report.scale = wanted.scale;
  IdVector<SubdomainId, Demand> demands(present_.parts.size());
  in_turns(demands.size(), to_index(threads), [&](std::size_t i) {
    const auto s = static_cast<SubdomainId>(i);
    const Part& part = present_.parts[s];
    demands[s] = demand_of(part.mesh->mesh, plan_.bounds, wanted.lengths[s], wanted.between, part.made_for.get());
  });
  IdVector<SubdomainId, Fate> fates;
  for (const SubdomainId s : ids_of(demands)) {
    fates.push_back(fate_of(present_.parts[s], demands[s], options_.coarsening));
    ++(fates[s] == Fate::kKeep ? report.kept : fates[s] == Fate::kMend ? report.mended : report.remade);
  }
  report.lengths = stage.seconds();

  stage = {};
  Parts parts = regenerate(plan_, present_.parts, wanted, demands, fates, threads, hooks);
  report.refine = stage.seconds();

  stage = {};
  Generation next = assemble(plan_.decomposition, pslg_, std::move(parts));
  finish_(next.piece.mesh);
  report.assemble = stage.seconds();

  stage = {};
  const Lineage lineage(present_, next, threads);
  std::vector<std::int32_t> points = lineage.stayed_points(), triangles = lineage.stayed_triangles();
  Fields fields = carried(fields_, lineage);
  report.transfer = stage.seconds();

  present_ = std::move(next);
  stayed_points_ = std::move(points);
  stayed_triangles_ = std::move(triangles);
  fields_ = std::move(fields);
  report.seconds = all.seconds();
  report_ = report;
}

void Session::attach(const std::string& name, std::vector<double> values, FieldPlace place, Transfer how) {
  fields_[name] = make_field(mesh(), name, std::move(values), place, how);
}

Field& Session::find_field(const std::string& name) {
  const auto found = fields_.find(name);
  if (found == fields_.end()) throw Error("there is no field '" + name + "'; attach it first");
  return found->second;
}

void Session::detach(const std::string& name) {
  (void)find_field(name);
  fields_.erase(name);
}

std::span<double> Session::field(const std::string& name) {
  return find_field(name).values;
}

}  // namespace driftmesh::adapt
