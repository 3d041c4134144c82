#include "driftmesh/adaptive.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "adapt/error_lengths.hpp"
#include "adapt/session.hpp"
#include "api/call.hpp"
#include "api/library_request.hpp"
#include "driftmesh/error.hpp"
#include "job/here.hpp"
#include "job/limits.hpp"
#include "job/make.hpp"

namespace driftmesh {
namespace {

/// The first generation, in subdomains that go on. Bounds that describe it alone are left behind.
job::LiveMesh first_generation(Call& call) {
  job::Here here(job::kSubdomains, call.threads());
  job::RunRecord record;
  job::LiveMesh live = job::make(call.asked(here.kind()), here, record, call.watch())->take_live();
  live.plan.bounds.plain.area = call.request().bounds.area;
  return live;
}

}  // namespace

struct AdaptiveMesh::Impl {
  Impl(const Pslg& input, const MeshOptions& mesh_options, const AdaptiveOptions& adaptive)
      : options(mesh_options), watch(options) {
    Call call(input, options);
    threads = call.threads();
    job::LiveMesh live = first_generation(call);
    limits = live.limits;
    session.emplace(
        adapt::Start{std::move(live.plan), std::move(live.pslg), std::move(live.parts), std::move(live.lengths)},
        adaptive, [rasters = std::move(live.rasters)](Mesh& mesh) {
          set_point_data(rasters, mesh);
          mesh.numbers.clear();  // only for points of a piece; this is the whole mesh
          mesh.ranks.clear();
        });
  }

  /// Calls work(hooks), which calls functions of the caller, unless one of them asks for that.
  template <class Work>
  void advance(const Work& work) {
    if (busy) throw Error("adapt is called by a function that adapt calls; return from it first");
    const adapt::Hooks hooks{
        .progress = [this](std::int64_t triangles, double forecast) { watch.refining(triangles, forecast); },
        .check = [this](std::int64_t triangles) { job::check_limits(limits, triangles); }};
    busy = true;
    try {
      in_words_of_library([&] { work(hooks); });
    } catch (...) {
      busy = false;
      throw;
    }
    busy = false;
  }

  MeshOptions options;
  CallerWatch watch;
  std::int32_t threads = 1;
  job::Limits limits;
  std::optional<adapt::Session> session;
  bool busy = false;
};

AdaptiveMesh::AdaptiveMesh(const Pslg& input, const MeshOptions& options, const AdaptiveOptions& adaptive) {
  in_words_of_library([&] { impl_ = std::make_unique<Impl>(input, options, adaptive); });
}
AdaptiveMesh::AdaptiveMesh(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh& AdaptiveMesh::operator=(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh::~AdaptiveMesh() = default;

const Mesh& AdaptiveMesh::mesh() const {
  return impl_->session->mesh();
}

const AdaptiveOptions& AdaptiveMesh::options() const {
  return impl_->session->options();
}

void AdaptiveMesh::adapt(std::span<const double> lengths) {
  impl_->advance([&](const adapt::Hooks& hooks) { impl_->session->adapt(lengths, impl_->threads, hooks); });
}

void AdaptiveMesh::adapt(const std::function<double(const Point&)>& size) {
  impl_->advance([&](const adapt::Hooks& hooks) {
    const FunctionField function(size);
    const job::Request request = request_of(impl_->options);
    const SizeSource source = job::size_of(request.sizing, {}, &function, impl_->session->pslg());
    impl_->session->adapt(*source.field, std::max(1, impl_->options.threads), hooks);  // it may not be made for more
  });
}

std::vector<double> AdaptiveMesh::lengths_from_error(std::span<const double> indicators, double target,
                                                     double order) const {
  return adapt::lengths_from_error(mesh(), indicators, target, order);
}

void AdaptiveMesh::attach(const std::string& name, std::vector<double> values, FieldPlace place, Transfer how) {
  impl_->session->attach(name, std::move(values), place, how);
}

void AdaptiveMesh::detach(const std::string& name) {
  impl_->session->detach(name);
}

std::span<double> AdaptiveMesh::field(const std::string& name) {
  return impl_->session->field(name);
}

std::span<const double> AdaptiveMesh::field(const std::string& name) const {
  return impl_->session->field(name);
}

const std::vector<std::int32_t>& AdaptiveMesh::stayed_points() const {
  return impl_->session->stayed_points();
}

const std::vector<std::int32_t>& AdaptiveMesh::stayed_triangles() const {
  return impl_->session->stayed_triangles();
}

const AdaptReport& AdaptiveMesh::report() const {
  return impl_->session->report();
}

}  // namespace driftmesh
