#include <doctest/doctest.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/mpi/adaptive.hpp"
#include "driftmesh/mpi/distributed.hpp"
#include "mpi/on_all_ranks.hpp"
#include "oracles/random_pslg.hpp"
#include "support/piece_of_whole.hpp"
#include "support/varied_domain.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// Adaptive meshes on real ranks, against the same in one process.

using namespace driftmesh;
using namespace driftmesh::mpi_test;

namespace {

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<double> at_points(const Mesh& mesh, const std::function<double(const Point&)>& function) {
  std::vector<double> values;
  for (const Point& p : mesh.points) values.push_back(function(p));
  return values;
}

/// A ring that grows.
double ring(const Point& p, int g) {
  const double away = std::fabs(std::hypot(p.x - 1, p.y - 1) - 0.3 - 0.1 * g);
  return 0.03 + 0.3 * std::max(0.0, away - 0.1);
}

/// The integral over the triangles of all ranks of a field that is linear between points.
double integral(const DistributedPiece& piece, std::span<const double> values) {
  double sum = 0;
  for (const auto& [a, b, c] : piece.mesh.triangles) {
    const Point &p = piece.mesh.points[a], &q = piece.mesh.points[b], &r = piece.mesh.points[c];
    sum += ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 6 * (values[a] + values[b] + values[c]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return sum;
}

const MeshOptions kOptions{.min_angle = 25, .max_area = 0.02, .threads = 1};

}  // namespace

TEST_CASE("an adaptive mesh on ranks is that of one process, bit for bit") {
  for (int seed = 1; seed <= 2; ++seed) {
    CAPTURE(seed);
    const Pslg input =
        seed == 1 ? testing::varied_domain() : oracles::make_random_pslg(7, oracles::make_random_shape(7)).input;
    MeshOptions options = kOptions;
    if (seed == 2) {
      options.max_area = 0;
      options.size = [](const Point& p) { return 0.05 + 0.1 * std::fabs(p.x); };
    }
    AdaptiveMesh whole(input, options);
    DistributedAdaptiveMesh mesh(MPI_COMM_WORLD, input, options);
    const auto wave = [](const Point& p) { return std::sin(9 * p.x) * std::cos(7 * p.y); };
    whole.attach("u", at_points(whole.mesh(), wave), FieldPlace::kPoints, Transfer::kConserve);
    mesh.attach("u", at_points(mesh.piece().mesh, wave), FieldPlace::kPoints, Transfer::kConserve);
    const double mass = integral(mesh.piece(), mesh.field("u"));
    for (int g = 1; g <= 4; ++g) {
      CAPTURE(g);
      if (g == 3) {
        const auto size = [](const Point& p) { return ring(p, 3); };
        whole.adapt(size);
        mesh.adapt(size);
      } else {
        whole.adapt(at_points(whole.mesh(), [&](const Point& p) { return ring(p, g); }));
        mesh.adapt(at_points(mesh.piece().mesh, [&](const Point& p) { return ring(p, g); }));
      }
      const testing::PieceOfWhole place(mesh.piece(), whole.mesh());
      CHECK(place.differences() == 0);
      CHECK(std::ranges::equal(mesh.field("u"), place.part_of(whole.field("u"), FieldPlace::kPoints)));
      CHECK(mesh.piece().total_triangles == static_cast<std::int64_t>(whole.mesh().triangles.size()));
      CHECK(std::fabs(integral(mesh.piece(), mesh.field("u")) - mass) < 1e-11);
    }
    const GhostedPiece ghosted = add_ghost_layer(MPI_COMM_WORLD, mesh.piece());
    CHECK(ghosted.own_triangles == static_cast<std::int32_t>(mesh.piece().mesh.triangles.size()));
    const TemporaryFolder folder;
    const std::string path = shared_path(folder, "mesh.pvtu");
    write_distributed(MPI_COMM_WORLD, mesh.piece(), path);
    if (own_rank() == 0) {
      VerifyOptions judge;
      judge.min_angle = 25;
      CHECK(verify(read_mesh(path), input, judge).accepted());
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

TEST_CASE("subdomains move by the time that is told, and change nothing; what is saved goes on anywhere") {
  const Pslg input = testing::varied_domain();
  AdaptiveMesh whole(input, kOptions);
  DistributedAdaptiveMesh mesh(MPI_COMM_WORLD, input, kOptions);
  const auto next = [&](auto& adaptive, const Mesh& of, int g) {
    adaptive.adapt(at_points(of, [&](const Point& p) { return ring(p, g); }));
  };
  whole.attach("u", std::vector<double>(whole.mesh().triangles.size(), 1), FieldPlace::kTriangles, Transfer::kConserve);
  mesh.attach("u", std::vector<double>(mesh.piece().mesh.triangles.size(), 1), FieldPlace::kTriangles,
              Transfer::kConserve);
  const auto check_as_whole = [&](const DistributedAdaptiveMesh& one) {
    const testing::PieceOfWhole place(one.piece(), whole.mesh());
    CHECK(place.differences() == 0);
    CHECK(std::ranges::equal(one.field("u"), place.part_of(whole.field("u"), FieldPlace::kTriangles)));
  };
  for (int g = 1; g <= 2; ++g) {
    CAPTURE(g);
    if (g == 1) {
      mesh.spent(own_rank() == 0 ? 4 : 1);
    } else {
      const std::vector<std::int32_t>& of_triangles = mesh.piece().mesh.subdomains;
      std::vector<double> seconds;
      for (std::size_t t = 0; t < of_triangles.size(); ++t)
        if (t == 0 || of_triangles[t] != of_triangles[t - 1]) seconds.push_back(of_triangles[t] % 4 == 0 ? 5 : 1);
      mesh.spent(seconds);
    }
    next(whole, whole.mesh(), g);
    next(mesh, mesh.piece().mesh, g);
    CHECK((mesh.report().moved > 0) == (rank_count() > 1));
    CHECK(mesh.report().imbalance < 1.5);
    check_as_whole(mesh);
  }
  const std::vector<double> none(mesh.piece().mesh.points.size(), 1);
  mesh.spent(own_rank() == 0 ? -1 : 1);
  if (rank_count() > 1) CHECK(mentions(common_error([&] { mesh.adapt(none); }), "rank 0: spent: -1 seconds"));
  check_as_whole(mesh);  // once more, though that is found when the next mesh is all but there

  const TemporaryFolder folder;
  const std::string path = shared_path(folder, "flow.h5");
  mesh.save(path);
  DistributedAdaptiveMesh on_ranks = DistributedAdaptiveMesh::load(MPI_COMM_WORLD, path);
  DistributedAdaptiveMesh on_one = DistributedAdaptiveMesh::load(MPI_COMM_SELF, path);
  AdaptiveMesh here = AdaptiveMesh::load(path, {.threads = 1});
  CHECK(here.report().generation == 2);
  next(whole, whole.mesh(), 3);
  next(here, here.mesh(), 3);
  for (DistributedAdaptiveMesh* loaded : {&on_ranks, &on_one}) {
    next(*loaded, loaded->piece().mesh, 3);
    check_as_whole(*loaded);
  }
  CHECK(std::ranges::equal(here.field("u"), whole.field("u")));
  MPI_Barrier(MPI_COMM_WORLD);
  CHECK(mentions(common_error([&] { (void)DistributedAdaptiveMesh::load(MPI_COMM_WORLD, path + "x"); }), path + "x"));
}

TEST_CASE("wrong use of an adaptive mesh is one clear error on all ranks") {
  const int last = rank_count() - 1;
  const bool odd = own_rank() == last;
  DistributedAdaptiveMesh mesh(MPI_COMM_WORLD, testing::varied_domain(), kOptions);
  const std::size_t points = mesh.piece().mesh.points.size();
  const auto adapted_by = [&](const std::vector<double>& lengths) {
    return common_error([&] { mesh.adapt(lengths); });
  };
  CHECK(mentions(adapted_by(std::vector<double>(odd ? 1 : points, 1.0)), "there are 1 lengths for"));
  for (const double wrong : {0.0, std::nan("")}) {
    std::vector<double> lengths(points, 0.1);
    if (odd) lengths.back() = wrong;
    CHECK(mentions(adapted_by(lengths), "a length must be positive"));
  }
  CHECK(mentions(common_error([&] { mesh.attach("u", std::vector<double>(odd ? points + 1 : points)); }),
                 "the same number for each"));
  CHECK(mentions(common_error([&] {
                   mesh.adapt([&](const Point&) -> double {
                     if (odd) throw Error("no size here");
                     return 0.1;
                   });
                 }),
                 "no size here"));
  CHECK(mentions(common_error([&] {
                   mesh.adapt([&](const Point&) {
                     mesh.adapt(std::vector<double>(points, 0.1));
                     return 0.1;
                   });
                 }),
                 "called by a function that adapt calls"));
  if (last > 0) {
    CHECK(mentions(common_error([&] {
                     if (odd)
                       mesh.detach("u");
                     else
                       mesh.adapt(std::vector<double>(points, 0.1));
                   }),
                   "calls detach, with field 'u'"));
    CHECK(mentions(common_error([&] {
                     DistributedAdaptiveMesh(MPI_COMM_WORLD, testing::varied_domain(), kOptions,
                                             {.gradation = odd ? 0.1 : 0.2});
                   }),
                   "gradation differs between ranks"));
  }
  CHECK(mentions(common_error([&] {
                   DistributedAdaptiveMesh(MPI_COMM_WORLD, testing::varied_domain(), kOptions, {.gradation = -1});
                 }),
                 "gradation"));
  CHECK_THROWS_AS(DistributedAdaptiveMesh(MPI_COMM_NULL, testing::varied_domain()), Error);
  MeshOptions few = kOptions;
  few.max_triangles = 3000;
  DistributedAdaptiveMesh limited(MPI_COMM_WORLD, testing::varied_domain(), few);
  CHECK_THROWS_AS(limited.adapt(std::vector<double>(limited.piece().mesh.points.size(), 0.02)), LimitError);
  CHECK(limited.report().generation == 0);
  mesh.adapt(std::vector<double>(points, 0.1));
  CHECK(mesh.report().generation == 1);
}
