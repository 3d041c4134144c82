#include "driftmesh/adaptive.hpp"

#include <string>
#include <utility>

#include "api/adaptive_core.hpp"
#include "api/call.hpp"
#include "api/library_request.hpp"
#include "distributed/ranks.hpp"
#include "job/here.hpp"

namespace driftmesh {

struct AdaptiveMesh::Impl {
  Impl(const Pslg& input, const MeshOptions& options, const AdaptiveOptions& adaptive)
      : core(options, Call(input, options).threads()) {
    Call call(input, core.options());
    job::Here here(job::kSubdomains, core.threads());
    core.begin(call, here, adaptive, alone, make_whole);
  }
  Impl(const std::string& path, const MeshOptions& options) : core(options, job::threads_of(request_of(options))) {
    core.resume(path, {}, alone, make_whole);
  }

  static void make_whole(Mesh& mesh) {
    mesh.numbers.clear();  // only for points of a piece
    mesh.ranks.clear();
  }

  OneRank alone;
  AdaptiveCore core;
};

AdaptiveMesh::AdaptiveMesh(const Pslg& input, const MeshOptions& options, const AdaptiveOptions& adaptive) {
  in_words_of_library([&] { impl_ = std::make_unique<Impl>(input, options, adaptive); });
}
AdaptiveMesh::AdaptiveMesh(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
AdaptiveMesh::AdaptiveMesh(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh& AdaptiveMesh::operator=(AdaptiveMesh&&) noexcept = default;
AdaptiveMesh::~AdaptiveMesh() = default;

AdaptiveMesh AdaptiveMesh::load(const std::string& path, const MeshOptions& options) {
  std::unique_ptr<Impl> impl;
  in_words_of_library([&] { impl = std::make_unique<Impl>(path, options); });
  return AdaptiveMesh(std::move(impl));
}

void AdaptiveMesh::save(const std::string& path) {
  in_words_of_library([&] { impl_->core.save(path, impl_->alone); });
}

const Mesh& AdaptiveMesh::mesh() const {
  return impl_->core.session().piece().mesh;
}

const AdaptiveOptions& AdaptiveMesh::options() const {
  return impl_->core.session().options();
}

void AdaptiveMesh::adapt(std::span<const double> lengths) {
  in_words_of_library([&] { impl_->core.adapt(lengths, impl_->alone); });
}

void AdaptiveMesh::adapt(const std::function<double(const Point&)>& size) {
  in_words_of_library([&] { impl_->core.adapt(size, impl_->alone); });
}

std::vector<double> AdaptiveMesh::lengths_from_error(std::span<const double> indicators, double target,
                                                     double order) const {
  return impl_->core.session().lengths_from_error(indicators, target, order, impl_->core.means(impl_->alone));
}

void AdaptiveMesh::attach(const std::string& name, std::vector<double> values, FieldPlace place, Transfer how,
                          std::vector<std::int64_t> shape) {
  impl_->core.session().attach(name, std::move(values), place, how, impl_->core.means(impl_->alone), std::move(shape));
}

void AdaptiveMesh::detach(const std::string& name) {
  impl_->core.session().detach(name, impl_->core.means(impl_->alone));
}

std::span<double> AdaptiveMesh::field(const std::string& name) {
  return impl_->core.session().field(name);
}

std::span<const double> AdaptiveMesh::field(const std::string& name) const {
  return impl_->core.session().field(name);
}

std::vector<std::int64_t> AdaptiveMesh::shape(const std::string& name) const {
  return impl_->core.session().shape(name);
}

std::map<std::string, FieldPlace> AdaptiveMesh::fields() const {
  return impl_->core.fields();
}

const std::vector<std::int32_t>& AdaptiveMesh::stayed_points() const {
  return impl_->core.session().stayed_points();
}

const std::vector<std::int32_t>& AdaptiveMesh::stayed_triangles() const {
  return impl_->core.session().stayed_triangles();
}

std::vector<std::vector<std::int32_t>> AdaptiveMesh::parents() const {
  return impl_->core.session().parents();
}

void AdaptiveMesh::keep_old(bool keep) {
  impl_->core.session().keep_old(keep);
}

const Mesh& AdaptiveMesh::old_mesh() const {
  return impl_->core.session().old_piece().mesh;
}

const AdaptReport& AdaptiveMesh::report() const {
  return impl_->core.session().report();
}

}  // namespace driftmesh
