#include "driftmesh/mpi/adaptive.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "api/adaptive_core.hpp"
#include "api/call.hpp"
#include "api/mpi/place_parts.hpp"
#include "api/mpi/with_team.hpp"
#include "base/formatted.hpp"
#include "job/rounds_on_ranks.hpp"
#include "job/same_on_ranks.hpp"
#include "job/with_ranks.hpp"

namespace driftmesh {
namespace {

std::vector<job::RankSetting> settings_of(const AdaptiveOptions& options) {
  const auto setting = [](const char* name, double value) {
    return job::RankSetting{KeyText::key(name), formatted("{}", value)};
  };
  return {setting("adaptive.shortest", options.shortest), setting("adaptive.longest", options.longest),
          setting("adaptive.gradation", options.gradation), setting("adaptive.coarsening", options.coarsening),
          setting("adaptive.most_triangles", options.most_triangles)};
}

}  // namespace

struct DistributedAdaptiveMesh::Impl {
  Impl(MPI_Comm ranks_of, const MeshOptions& options)
      : communicator(ranks_of), core(options, std::max(1, options.threads)) {}

  /// Does work(ranks), collectively.
  template <class Work>
  void together(const Work& work) {
    core.require_rest();
    static_cast<void>(with_team(communicator, [&](job::Team& team) {
      job::with_ranks(team, work);
      return true;
    }));
  }

  [[nodiscard]] adapt::Placing placing(Ranks& ranks) const {
    return [this, &ranks](const adapt::Loads& loads, const adapt::Generation& generation,
                          const Decomposition& decomposition) {
      return place_parts(communicator, ranks, decomposition, loads, generation);
    };
  }

  MPI_Comm communicator;
  AdaptiveCore core;
};

DistributedAdaptiveMesh::DistributedAdaptiveMesh(MPI_Comm communicator, const Pslg& input, const MeshOptions& options,
                                                 const AdaptiveOptions& adaptive)
    : impl_(std::make_unique<Impl>(communicator, options)) {
  in_words_of_library([&] {
    Call call(input, impl_->core.options());
    static_cast<void>(with_team(communicator, [&](job::Team& team) {
      std::vector<job::RankSetting> settings = settings_of(options, call.request());
      for (job::RankSetting& setting : settings_of(adaptive)) settings.push_back(std::move(setting));
      job::require_same(team, settings);
      job::with_ranks(team, [&](Ranks& ranks) {
        job::RoundsOnRanks place(team, ranks, impl_->core.threads());
        impl_->core.begin(call, place, adaptive, ranks, [](Mesh&) {});
      });
      return true;
    }));
  });
}
DistributedAdaptiveMesh::DistributedAdaptiveMesh(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DistributedAdaptiveMesh::DistributedAdaptiveMesh(DistributedAdaptiveMesh&&) noexcept = default;
DistributedAdaptiveMesh& DistributedAdaptiveMesh::operator=(DistributedAdaptiveMesh&&) noexcept = default;
DistributedAdaptiveMesh::~DistributedAdaptiveMesh() = default;

DistributedAdaptiveMesh DistributedAdaptiveMesh::load(MPI_Comm communicator, const std::string& path,
                                                      const MeshOptions& options) {
  auto impl = std::make_unique<Impl>(communicator, options);
  static_cast<void>(with_team(communicator, [&](job::Team& team) {
    std::vector<job::RankSetting> settings = settings_of(options, request_of(options));
    settings.push_back({"the path", path});
    job::require_same(team, settings);
    job::with_ranks(team, [&](Ranks& ranks) { impl->core.resume(path, job::processes_of(team), ranks, [](Mesh&) {}); });
    return true;
  }));
  return DistributedAdaptiveMesh(std::move(impl));
}

void DistributedAdaptiveMesh::save(const std::string& path) {
  impl_->together([&](Ranks& ranks) { impl_->core.save(path, ranks); });
}

const DistributedPiece& DistributedAdaptiveMesh::piece() const {
  return impl_->core.session().piece();
}

const AdaptiveOptions& DistributedAdaptiveMesh::options() const {
  return impl_->core.session().options();
}

void DistributedAdaptiveMesh::adapt(std::span<const double> lengths) {
  impl_->together([&](Ranks& ranks) { impl_->core.adapt(lengths, ranks, impl_->placing(ranks)); });
}

void DistributedAdaptiveMesh::adapt(const std::function<double(const Point&)>& size) {
  impl_->together([&](Ranks& ranks) { impl_->core.adapt(size, ranks, impl_->placing(ranks)); });
}

std::vector<double> DistributedAdaptiveMesh::lengths_from_error(std::span<const double> indicators, double target,
                                                                double order) const {
  std::vector<double> lengths;
  impl_->together([&](Ranks& ranks) {
    lengths = impl_->core.session().lengths_from_error(indicators, target, order, impl_->core.means(ranks));
  });
  return lengths;
}

void DistributedAdaptiveMesh::attach(const std::string& name, std::vector<double> values, FieldPlace place,
                                     Transfer how, std::vector<std::int64_t> shape) {
  impl_->together([&](Ranks& ranks) {
    impl_->core.session().attach(name, std::move(values), place, how, impl_->core.means(ranks), std::move(shape));
  });
}

void DistributedAdaptiveMesh::detach(const std::string& name) {
  impl_->together([&](Ranks& ranks) { impl_->core.session().detach(name, impl_->core.means(ranks)); });
}

void DistributedAdaptiveMesh::spent(double seconds) {
  impl_->core.session().spent(seconds);
}

void DistributedAdaptiveMesh::spent(std::span<const double> seconds) {
  impl_->core.session().spent(seconds);
}

std::span<double> DistributedAdaptiveMesh::field(const std::string& name) {
  return impl_->core.session().field(name);
}

std::span<const double> DistributedAdaptiveMesh::field(const std::string& name) const {
  return impl_->core.session().field(name);
}

std::vector<std::int64_t> DistributedAdaptiveMesh::shape(const std::string& name) const {
  return impl_->core.session().shape(name);
}

std::map<std::string, FieldPlace> DistributedAdaptiveMesh::fields() const {
  return impl_->core.fields();
}

const std::vector<std::int32_t>& DistributedAdaptiveMesh::stayed_points() const {
  return impl_->core.session().stayed_points();
}

const std::vector<std::int32_t>& DistributedAdaptiveMesh::stayed_triangles() const {
  return impl_->core.session().stayed_triangles();
}

std::vector<std::vector<std::int32_t>> DistributedAdaptiveMesh::parents() const {
  return impl_->core.session().parents();
}

void DistributedAdaptiveMesh::keep_old(bool keep) {
  impl_->core.session().keep_old(keep);
}

const DistributedPiece& DistributedAdaptiveMesh::old_piece() const {
  return impl_->core.session().old_piece();
}

const AdaptReport& DistributedAdaptiveMesh::report() const {
  return impl_->core.session().report();
}

}  // namespace driftmesh
