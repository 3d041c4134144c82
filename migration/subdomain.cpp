#include "migration/subdomain.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "mesh/forecast.hpp"
#include "mesh/refiner.hpp"
#include "protocol/packed_size.hpp"

namespace driftmesh {
namespace {

std::int64_t points_made(const RefineCounters& c) {
  return c.free_points + c.segment_points;
}

RefinerState rest_of(const DormantBody& dormant, const Triangulation& mesh, const QualityBounds& bounds) {
  RefinerState state = RefinerState::at_rest(mesh, bounds);
  state.unsplittable.insert(dormant.unsplittable.begin(), dormant.unsplittable.end());
  state.max_triangles = dormant.max_triangles;
  state.counters = dormant.counters;
  return state;
}

/// The state of a refiner that has finished a mesh but for triangles that are still open.
RefinerState beginning_of(const Beginning& begin, const SizeBounds& sizes) {
  const Triangulation& mesh = begin.mesh->mesh;
  RefinerState state;
  if (begin.lengths != nullptr)
    state.size = *begin.lengths;
  else
    state = RefinerState::at_start(mesh, sizes);
  state.stage = begin.open.empty() ? RefinerState::Stage::kDone : RefinerState::Stage::kRest;
  state.next_segment = mesh.subsegments.next_id();
  state.sweep.end();
  for (const TriangleId t : begin.open) state.sweep.visit_again(t);
  return state;
}

/// Why a mesh does not belong to subdomain i; empty if it does. `label`: its highest region label.
std::string misfit(const SubdomainMesh& part, std::uint16_t label, const Decomposition& d, SubdomainId i) {
  if (!std::ranges::equal(part.roots, d.roots_of(i))) return "its border differs";
  std::uint16_t last_label = 0;
  for (const GlobalRootId r : part.roots) {
    const Decomposition::Root& root = d.roots[r];
    last_label = std::max({last_label, root.left_region, root.right_region});
  }
  if (label > last_label) return "it has an unknown region";
  if (!std::ranges::all_of(part.points, [&](GlobalPointId v) { return d.points.has(v); }))
    return "it has an unknown point";
  return "";
}

std::uint16_t highest_label(const SubdomainState& state) {
  std::uint16_t label = 0;
  if (state.body)
    for (const std::uint16_t l : state.body->part.mesh.region) label = std::max(label, l);
  else
    state.dormant->mesh.visit_triangles([&](const auto&, std::uint16_t l) { label = std::max(label, l); });
  return label;
}

/// Why an unpacked subdomain does not belong to this decomposition; empty if it does.
std::string misfit(const SubdomainState& state, const Decomposition& d) {
  if (!d.subdomains.has(state.id)) return "there are only " + std::to_string(d.size());
  for (const SplitPoint<GlobalRootId>& split : state.pending)
    if (!d.roots.has(split.root)) return "a point waits for a root that does not exist";
  if (state.body) return misfit(state.body->part, highest_label(state), d, state.id);
  if (state.dormant) return misfit(state.dormant->mesh.skeleton(), highest_label(state), d, state.id);
  return "";
}

}  // namespace

struct Subdomain::Body {
  Body(SubdomainMesh&& made, const QualityBounds& bounds)
      : part(std::move(made)), refiner(part.mesh, bounds), forecast(forecast_triangles(part.mesh, bounds)) {}
  Body(SubdomainState::Body&& packed, const QualityBounds& bounds)
      : part(std::move(packed.part)),
        refiner(part.mesh, bounds, std::move(packed.refiner)),
        forecast(packed.forecast) {}
  Body(DormantBody&& dormant, const QualityBounds& bounds)
      : part(dormant.mesh.wake()),
        refiner(part.mesh, bounds, rest_of(dormant, part.mesh, bounds)),
        forecast(dormant.forecast) {}

  SubdomainMesh part;
  Refiner refiner;
  double forecast;  // triangles when all bounds are met
};

Subdomain::Subdomain(SubdomainId id, const SubdomainContext& context) : Work(id), context_(&context) {
  const Beginning* const begin = beginning();
  if (begin == nullptr) return;
  refined_ = begin->mesh != nullptr && begin->open.empty();
  tell(begin->told);
}
Subdomain::Subdomain(Subdomain&&) noexcept = default;
Subdomain& Subdomain::operator=(Subdomain&&) noexcept = default;
Subdomain::~Subdomain() = default;

const SubdomainMesh& Subdomain::mesh() const {
  return body_->part;
}

SubdomainMesh Subdomain::take_mesh() {
  wake();
  return std::move(body_->part);
}

/// Null if it begins like all others do.
const Beginning* Subdomain::beginning() const {
  return context_->beginnings == nullptr ? nullptr : &(*context_->beginnings)[id()];
}

QualityBounds Subdomain::bounds() const {
  QualityBounds bounds = context_->bounds;
  if (const Beginning* const begin = beginning(); begin != nullptr && begin->size != nullptr) bounds.size = begin->size;
  return bounds;
}

const GrowingArray<double, VertexId>& Subdomain::lengths() const {
  return body_->refiner.state().size;
}

const RefineCounters& Subdomain::counters() const {
  return dormant_ ? dormant_->counters : body_->refiner.counters();
}

double Subdomain::forecast() const {
  if (dormant_) return dormant_->forecast;
  return body_ ? body_->forecast : context_->decomposition->subdomains[id()].predicted;
}

double Subdomain::remaining() const {
  if (!active()) return 0;
  // Only single points remain for a subdomain that has exceeded its forecast, or has met its bounds before.
  return std::max(forecast() - static_cast<double>(triangles()), 1 + static_cast<double>(pending_.size()));
}

std::int64_t Subdomain::triangles() const {
  if (dormant_) return dormant_->mesh.triangles();
  if (body_) return static_cast<std::int64_t>(body_->part.mesh.live_triangles());
  const Beginning* const begin = beginning();
  return begin != nullptr && begin->mesh ? static_cast<std::int64_t>(begin->mesh->mesh.live_triangles()) : 0;
}

WorkState Subdomain::state() const {
  return {.active = active(),
          .started = started(),
          .refined = refined(),
          .backlog = backlog(),
          .triangles = triangles(),
          .predicted = context_->decomposition->subdomains[id()].predicted,
          .forecast = forecast(),
          .remaining = remaining(),
          .packed_bytes = packed_bytes()};
}

std::uint64_t Subdomain::packed_bytes() const {
  constexpr std::uint64_t kOverhead = 200;
  return kOverhead + protocol::kBytesPerTriangle * static_cast<std::uint64_t>(triangles()) +
         sizeof(SplitPoint<GlobalRootId>) * pending_.size();
}

SliceWork Subdomain::work(std::int64_t insertions, std::vector<SplitPoint<GlobalRootId>>& said) {
  SliceWork done;
  if (dormant_) done.woken = triangles();
  wake();
  if (!body_) {
    make_body();
    done.begun = true;
    done.prepared = triangles();
  }
  const std::int64_t points_before = points_made(counters()), triangles_before = triangles();
  for (const SplitPoint<GlobalRootId>& split : std::exchange(pending_, {})) take_in(split);
  switch (body_->refiner.refine(insertions)) {
    case Refiner::Status::kDone:
      refined_ = true;
      break;
    case Refiner::Status::kBudget:
      refined_ = false;
      break;
    case Refiner::Status::kFull:
      throw LimitError("subdomain " + to_string(id()) +
                       " has more triangles than can be numbered; cut the domain into more subdomains");
  }
  say_new_points(said);
  done.points = points_made(counters()) - points_before;
  done.triangles = triangles() - triangles_before;
  return done;
}

std::int64_t Subdomain::rest() {
  if (context_->finished) context_->finished(*this);
  if (!context_->sleep) return 0;
  sleep();
  return dormant() ? triangles() : 0;
}

void Subdomain::sleep() {
  if (!body_ || active()) return;
  fall_asleep(asleep());
  body_.reset();
}

void Subdomain::fall_asleep(DormantBody&& dormant) {
  dormant_ = std::make_unique<DormantBody>(std::move(dormant));
  if (context_->scratch != nullptr) stored_.emplace(*context_->scratch, dormant_->mesh.take());
}

DormantBody Subdomain::asleep() const {
  const RefinerState& refiner = body_->refiner.state();
  DormantBody dormant;
  dormant.mesh = DormantMesh(body_->part);
  const auto waking = DormantMesh::waking_subsegments(body_->part.mesh);
  for (const SubsegmentId s : refiner.unsplittable) dormant.unsplittable.push_back(waking[s]);
  std::ranges::sort(dormant.unsplittable);
  dormant.max_triangles = refiner.max_triangles;
  dormant.counters = refiner.counters;
  dormant.forecast = body_->forecast;
  return dormant;
}

SubdomainMesh Subdomain::woken() const {
  return stored_ ? whole_dormant().mesh.wake() : dormant_->mesh.wake();
}

DormantBody Subdomain::whole_dormant() const {
  DormantBody whole = *dormant_;
  if (stored_) whole.mesh.give(stored_->read());
  return whole;
}

void Subdomain::wake() {
  if (!dormant_) return;
  if (stored_) dormant_->mesh.give(stored_->read());
  stored_.reset();
  try {
    body_ = std::make_unique<Body>(std::move(*dormant_), bounds());
  } catch (const Error& error) {
    throw Error("the dormant form of subdomain " + to_string(id()) + " is damaged: " + error.what());
  }
  dormant_.reset();
}

/// Whether it already has the point.
bool Subdomain::has(const SplitPoint<GlobalRootId>& split) const {
  const Beginning* const begin = beginning();
  if (!started() && (begin == nullptr || !begin->mesh)) return false;
  const auto roots = context_->decomposition->roots_of(id());
  const auto place = std::ranges::lower_bound(roots, split.root);
  if (place == roots.end() || *place != split.root) return false;
  const auto root = static_cast<RootId>(place - roots.begin());
  if (dormant_) return dormant_->mesh.holds(root, split.path);
  const Triangulation& mesh = body_ ? body_->part.mesh : begin->mesh->mesh;
  return !mesh.subsegments[mesh.descend(root, split.path)].is_leaf();
}

Bytes Subdomain::pack() const {
  SubdomainView view{id(), refined_, pending_, {}, nullptr};
  if (body_) view.body.emplace(SubdomainView::Body{body_->part, body_->refiner.state(), body_->forecast});
  if (!stored_) {
    view.dormant = dormant_.get();
    return driftmesh::pack(view);
  }
  const DormantBody whole = whole_dormant();
  view.dormant = &whole;
  return driftmesh::pack(view);
}

Bytes Subdomain::pack_small() const {
  if (!body_ || active()) return pack();
  const DormantBody dormant = asleep();
  return driftmesh::pack(SubdomainView{id(), refined_, pending_, {}, &dormant});
}

Subdomain Subdomain::unpack(std::span<const std::byte> bytes, const SubdomainContext& context, Source source) {
  SubdomainState state = driftmesh::unpack(bytes, source);
  const std::string fault = misfit(state, *context.decomposition);
  if (!fault.empty())
    throw Error("the packed form of subdomain " + to_string(state.id) +
                " does not belong to this decomposition: " + fault + "; use the one that it was packed with");
  Subdomain subdomain(state.id, context);
  subdomain.refined_ = state.refined;
  subdomain.pending_ = std::move(state.pending);
  try {
    if (state.body) subdomain.body_ = std::make_unique<Body>(std::move(*state.body), subdomain.bounds());
    if (state.dormant && source == Source::kUnknown)
      Body(DormantBody(*state.dormant), subdomain.bounds());  // it can wake
  } catch (const Error& error) {
    throw Error("the packed form of subdomain " + to_string(state.id) + " is damaged: " + error.what());
  }
  if (state.dormant) subdomain.fall_asleep(std::move(*state.dormant));
  return subdomain;
}

void Subdomain::make_body() {
  const Beginning* const begin = beginning();
  if (begin != nullptr && begin->mesh) {
    const SubdomainMesh& mesh = *begin->mesh;
    const auto triangles = static_cast<double>(mesh.mesh.live_triangles());
    body_ = std::make_unique<Body>(SubdomainState::Body{mesh, beginning_of(*begin, SizeBounds(bounds())), triangles},
                                   bounds());
    return;
  }
  body_ = std::make_unique<Body>(subdomain_triangulation(*context_->decomposition, id()), bounds());
  if (!context_->presplit) return;
  for (const GlobalRootId root : body_->part.roots)
    for (const dyadic::Path path : presplit_of(root)) take_in({root, path});
}

std::vector<dyadic::Path> Subdomain::presplit_of(GlobalRootId root) const {
  if (context_->presplit_paths == nullptr) return presplit_paths(*context_->decomposition, root, bounds());
  const auto found = context_->presplit_paths->find(root);
  return found == context_->presplit_paths->end() ? std::vector<dyadic::Path>() : found->second;
}

void Subdomain::take_in(const SplitPoint<GlobalRootId>& split) {
  const IdVector<RootId, GlobalRootId>& roots = body_->part.roots;
  const auto place = std::lower_bound(roots.begin(), roots.end(), split.root);
  if (place == roots.end() || *place != split.root)
    throw Error("subdomain " + to_string(id()) + " is told of a point on root " + to_string(split.root) +
                ", which is not on its border");
  if (!body_->refiner.add_split_point(static_cast<RootId>(place - roots.begin()), split.path))
    throw Error("root " + to_string(split.root) + " of the decomposition, between subdomain " + to_string(id()) +
                " and a neighbor, cannot be split at depth " + std::to_string(dyadic::depth(split.path)) +
                ": coordinates have no room for the point; ask for larger triangles or a smaller angle there");
}

void Subdomain::say_new_points(std::vector<SplitPoint<GlobalRootId>>& said) {
  for (const SplitPoint<RootId>& p : body_->refiner.take_split_points()) {
    const GlobalRootId root = body_->part.roots[p.root];
    if (context_->decomposition->roots[root].is_interface()) said.push_back({root, p.path});
  }
}

}  // namespace driftmesh
