#include "api/adaptive_core.hpp"

#include <algorithm>
#include <utility>

#include "api/library_request.hpp"
#include "base/bytes.hpp"
#include "driftmesh/error.hpp"
#include "job/domain.hpp"
#include "job/make.hpp"

namespace driftmesh {

void AdaptiveCore::begin(Call& call, job::Place& place, const AdaptiveOptions& adaptive, Ranks& ranks,
                         const std::function<void(Mesh&)>& finish) {
  job::RunRecord record;
  job::LiveMesh live;
  ranks.alike(
      [&] { live = job::make(call.asked(job::kSubdomains), place, record, call.watch())->take_live(call.request()); });
  limits_ = live.limits;
  rasters_ = std::move(live.rasters);
  session_.emplace(
      adapt::Start{std::move(live.plan), std::move(live.pslg), std::move(live.parts), std::move(live.lengths)},
      adaptive, finishing(finish), means(ranks));
}

void AdaptiveCore::resume(const std::string& path, const job::Processes& processes, Ranks& ranks,
                          const std::function<void(Mesh&)>& finish) {
  adapt::Saved saved = adapt::read_saved(path, ranks);
  ranks.agree([&] {
    const job::Request request = request_of(options_);
    limits_ = job::find_limits(request.limits, saved.head.pslg,
                               {.by = job::kLibrary, .in_subdomains = true, .writes = true}, processes);
    ByteReader reader(saved.head.more);
    rasters_ = job::Rasters::read(reader);
    open_all(rasters_, job::box_of(saved.head.pslg), {});
  });
  session_.emplace(std::move(saved), finishing(finish), means(ranks));
}

void AdaptiveCore::save(const std::string& path, Ranks& ranks) {
  ByteWriter more;
  rasters_.write(more);
  session_->save(path, more.take(), means(ranks));
}

std::function<void(Mesh&)> AdaptiveCore::finishing(const std::function<void(Mesh&)>& finish) const {
  return [this, finish](Mesh& mesh) {
    set_point_data(rasters_, mesh);
    finish(mesh);
  };
}

std::map<std::string, FieldPlace> AdaptiveCore::fields() const {
  std::map<std::string, FieldPlace> all;
  for (const auto& [name, field] : session_->fields()) all.emplace(name, field.place);
  return all;
}

void AdaptiveCore::require_rest() const {
  if (busy_) throw Error("adapt is called by a function that adapt calls; return from it first");
}

/// Calls work(hooks), which calls functions of the caller, unless one of them asks for that.
template <class Work>
void AdaptiveCore::advance(const Work& work) {
  constexpr const char* kLeft = "The mesh is as it was";
  require_rest();
  const adapt::Hooks hooks{
      .progress = [this](std::int64_t triangles, double forecast) { watch_.refining(triangles, forecast); },
      .check = [this](std::int64_t triangles) { job::check_limits(limits_, triangles, kLeft); },
      .check_all = [this](std::int64_t triangles) { job::check_number(limits_, triangles, kLeft); }};
  busy_ = true;
  try {
    work(hooks);
  } catch (...) {
    busy_ = false;
    throw;
  }
  busy_ = false;
}

void AdaptiveCore::adapt(std::span<const double> lengths, Ranks& ranks, const adapt::Placing& place) {
  advance([&](const adapt::Hooks& hooks) { session_->adapt(lengths, {ranks, threads_, place}, hooks); });
}

void AdaptiveCore::adapt(const std::function<double(const Point&)>& size, Ranks& ranks, const adapt::Placing& place) {
  advance([&](const adapt::Hooks& hooks) {
    session_->require_same_call("adapt, with a size", ranks);
    const FunctionField function(size);
    const job::Request request = request_of(options_);
    SizeSource source;
    ranks.agree([&] { source = job::size_of(request.sizing, {}, &function, session_->pslg()); });
    const std::int32_t threads = std::max(1, options_.threads);  // it may not be made for more
    session_->adapt(*source.field, {ranks, threads, place}, hooks);
  });
}

}  // namespace driftmesh
