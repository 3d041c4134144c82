#include "job/one_piece.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/stopwatch.hpp"
#include "distributed/exchange.hpp"
#include "distributed/write_distributed.hpp"
#include "io/mesh_file.hpp"
#include "io/other_coordinates.hpp"
#include "job/memory.hpp"
#include "job/write_files.hpp"
#include "mesh/cdt.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "mesh/narrow_place.hpp"
#include "mesh/refiner.hpp"
#include "mesh/to_piece.hpp"

namespace driftmesh::job {
namespace {

/// A whole mesh as the only piece. `numbered`: for a file in pieces.
DistributedPiece as_piece(Mesh mesh, bool numbered) {
  DistributedPiece piece;
  piece.has_regions = !mesh.regions.empty();
  if (numbered) {
    mesh.numbers.resize(mesh.points.size());
    std::iota(mesh.numbers.begin(), mesh.numbers.end(), 0);
    mesh.subdomains.resize(mesh.triangles.size());
    mesh.ranks.resize(mesh.triangles.size());
  }
  piece.mesh = std::move(mesh);
  return piece;
}

class OnePiece final : public Refined {
 public:
  OnePiece(Order&& order, const Limits& limits, std::int32_t threads, Watch& watch)
      : domain_(std::move(order.whole->domain)),
        limits_(limits),
        holes_(std::move(order.whole->triangulated.holes)),
        threads_(threads),
        mesh_(std::move(order.whole->triangulated.mesh)),
        bounds_(std::move(order.whole->triangulated.bounds)) {
    refine(order.whole->triangulated.forecast, watch);
  }

  void report(RunRecord& record) override {
    record.seconds_refine = seconds_;
    record.peak_refining = peak_memory();
    record.stopped_by = Limits::key(by_memory_);
    record.complete = complete_;
    const bool capped = room_under_cap() != UINT64_MAX;  // the stacks of threads would count
    add_part(record, mesh_, bounds_, complete_, !capped && threads_ > 1);
    add_counters(record, counters_);
  }

  [[nodiscard]] const RunPlan* plan() const override { return nullptr; }

  [[nodiscard]] KeyText shortfall(bool kept) override {
    if (complete_) return {};
    mesh_ = {};  // its memory is needed
    return stopped_message(limits_, by_memory_, triangles_, kept, find_narrow_place(triangulate(domain_.pslg)));
  }

  void write(const Request::Output& files, const Draw& draw, Watch& watch) override {
    const bool in_pieces = std::ranges::any_of(files.meshes, is_in_pieces);
    DistributedPiece piece = as_piece(timed(watch, "convert", [&] { return converted(); }), in_pieces);
    if (in_pieces)
      timed(watch, "write", [&] {
        for_each_in_pieces(files, watch, [&](const std::string& path) {
          const std::string wanted = coordinates_wanted(piece.mesh, path, writing_of(files, {}, watch));
          DistributedPiece moved;
          if (!wanted.empty()) change_coordinates((moved = piece).mesh, wanted, path);
          WritePieces writing(wanted.empty() ? piece : moved, path);
          exchange_directly(IdVector<Rank, Exchange*>{&writing});
        });
      });
    if (needs_whole(files)) write_whole(files, piece.mesh, holes_, draw, watch);
  }

  [[nodiscard]] DistributedPiece take_piece(Watch& watch) override {
    return as_piece(timed(watch, "convert", [&] { return converted(); }), false);
  }

 private:
  /// Tells the watch how far it is before and after each of a few milliseconds, which make about a megabyte.
  void refine(double forecast, Watch& watch) {
    constexpr std::int64_t kInsertions = 10'000;
    const Stopwatch refining;
    Refiner refiner(mesh_, bounds_);
    refiner.limit_triangles(limits_.triangles);
    const auto goes_on = [&] {
      const auto triangles = static_cast<std::int64_t>(mesh_.live_triangles());
      watch.refining(triangles, forecast);
      by_memory_ = memory_is_full(limits_, triangles);
      return !by_memory_;
    };
    Refiner::Status status = Refiner::Status::kBudget;
    while (goes_on() && status == Refiner::Status::kBudget) status = refiner.refine(kInsertions);
    complete_ = status == Refiner::Status::kDone;
    counters_ = refiner.counters();
    triangles_ = static_cast<std::int64_t>(mesh_.live_triangles());
    seconds_ = refining.seconds();
  }

  [[nodiscard]] Mesh converted() {
    Mesh mesh = to_piece(std::exchange(mesh_, {}), domain_.pslg);
    interpolate_attributes(domain_.pslg, mesh);
    set_point_data(domain_.rasters, mesh);
    return mesh;
  }

  Domain domain_;
  Limits limits_;
  std::vector<Point> holes_;
  std::int32_t threads_;
  Triangulation mesh_;
  QualityBounds bounds_;
  RefineCounters counters_;
  double seconds_ = 0;
  bool complete_ = false;
  bool by_memory_ = false;
  std::int64_t triangles_ = 0;
};

}  // namespace

std::unique_ptr<Refined> refine_in_one_piece(Order&& order, const Limits& limits, std::int32_t threads, Watch& watch) {
  return std::make_unique<OnePiece>(std::move(order), limits, threads, watch);
}

}  // namespace driftmesh::job
