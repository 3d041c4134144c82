#include "app/parallel_mesh.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "app/drag.hpp"
#include "app/limits.hpp"
#include "app/memory.hpp"
#include "app/output_files.hpp"
#include "app/rank_report.hpp"
#include "app/run_notes.hpp"
#include "balancer/mpi/mpi_council.hpp"
#include "base/byte_stream.hpp"
#include "base/error.hpp"
#include "decompose/decomposition_file.hpp"
#include "distributed/assembly.hpp"
#include "distributed/write_distributed.hpp"
#include "io/mesh_file.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/mesher.hpp"
#include "picture/plot.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "pslg/poly_file.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh::app {
namespace {

using protocol::Bytes;

/// What rank 0 gives to all before the work begins.
struct Start {
  bool failed = false;  ///< rank 0 has an error to report; all others leave
  Bytes plan;
  Bytes pslg;

  [[nodiscard]] Bytes pack() const {
    ByteWriter writer;
    writer.value(failed);
    writer.array(plan);
    writer.array(pslg);
    return writer.take();
  }
  static Start unpack(const Bytes& bytes) {
    ByteReader reader(bytes);
    Start start;
    reader.value(start.failed);
    reader.array(start.plan);
    reader.array(start.pslg);
    return start;
  }
};

class ParallelMesh {
 public:
  ParallelMesh(const MeshOptions& options, const std::string& command, protocol::MpiTransport& transport)
      : options_(options),
        transport_(transport),
        leader_(transport.rank() == 0),
        notes_(options, command, !leader_),
        run_(notes_.run) {}

  int go() {
    const Start start = agree();
    if (start.failed) return 0;  // rank 0 has the error and the code for it
    try {
      plan_ = plan_from_bytes(start.plan, transport_.ranks());
      pslg_ = pslg_from_bytes(start.pslg);
      size_ = make_size_field(options_.sizing);
      plan_.bounds.size = size_.get();
      refine();
      report();
      if (!options_.outputs.empty() || !options_.picture.empty()) write();
    } catch (const LimitError& error) {
      const bool of_triangles = loop_ && loop_->triangles() > limits_.triangles;
      fail(of_triangles ? stopped_message(limits_, loop_->triangles(), true) + ". No mesh was written" : error.what(),
           kStoppedByLimit);
    } catch (const std::bad_alloc&) {
      fail(kOutOfMemory, kStoppedByLimit);
    } catch (const std::exception& error) {
      if (transport_.ranks() == 1) throw;
      fail(error.what(), EXIT_FAILURE);
    }
    if (leader_) notes_.finish();
    return 0;
  }

 private:
  /// All ranks wait for one that fails by itself: it takes them with it.
  [[noreturn]] void fail(const std::string& why, int code) const {
    if (transport_.ranks() == 1) throw LimitError(why);
    protocol::MpiSession::abort(fmt::format("driftmesh: rank {}: {}", transport_.rank(), why), code);
  }

  /// The plan, as rank 0 makes it, on all ranks. Throws there what goes wrong with it, and tells the others so.
  Start agree() {
    ranks_on_machine_ = protocol::MpiSession::ranks_on_this_machine();
    Start start;
    if (leader_) {
      try {
        start = plan();
      } catch (...) {
        start.failed = true;
        static_cast<void>(transport_.broadcast(start.pack()));
        throw;
      }
    }
    return notes_.timed("share", [&] { return Start::unpack(transport_.broadcast(start.pack())); });
  }

  Start plan() {
    if (options_.keep_incomplete)
      throw Error(
          "--keep-incomplete is for a mesh in one piece: what ranks have made when one stops does not fit together");
    check_outputs(options_.outputs, options_.picture, options_.json, options_.input, transport_.ranks());
    Pslg pslg = notes_.timed("read", [&] { return read_poly(options_.input); });
    notes_.timed("repair", [&] { notes_.repair_input(pslg); });
    const auto size = notes_.timed("size", [&] { return make_size_field(options_.sizing); });
    const MeshRequest request{options_.angle, options_.area, !options_.no_region_areas, size.get(),
                              options_.max_triangles};
    const QualityBounds bounds = bounds_of(pslg, request);
    const Triangulation mesh = notes_.timed("triangulate", [&] {
      Triangulation made = triangulate(pslg);
      run_.acute_corners = prepare_corners(made);
      return made;
    });
    check_forecast(limits_of_all(pslg), forecast_triangles(mesh, bounds), false);
    Decomposition cut = options_.parts.decomposition.empty() ? decompose_input(mesh, bounds) : load(pslg);
    for (const Decomposition::Subdomain& s : cut.subdomains) run_.forecast += s.predicted;
    RunPlan plan = notes_.timed("map", [&] { return plan_run(std::move(cut), bounds, plan_options()); });
    return {false, plan_to_bytes(plan), pslg_to_bytes(pslg)};
  }

  /// Memory is that of each rank, --max-triangles the limit of all together.
  [[nodiscard]] Limits limits_of_all(const Pslg& pslg) const {
    Limits limits = find_limits(options_, pslg, ranks_on_machine_);
    if (!limits.by_memory) return limits;
    limits.by_memory = limits.triangles < options_.max_triangles / transport_.ranks();
    limits.triangles = limits.by_memory ? limits.triangles * transport_.ranks() : options_.max_triangles;
    limits.memory *= static_cast<std::uint64_t>(transport_.ranks());
    return limits;
  }

  Decomposition decompose_input(const Triangulation& mesh, const QualityBounds& bounds) {
    const MeshOptions::Parts& parts = options_.parts;
    const DecomposeOptions cutting{parts.subdomains, parts.separator_angle, bounds, parts.skew, parts.seed};
    return notes_.timed("decompose", [&] { return decompose_for(mesh, cutting, transport_.ranks()); });
  }

  Decomposition load(const Pslg& pslg) {
    return notes_.timed("load", [&] { return read_decomposition(options_.parts.decomposition, pslg); });
  }

  [[nodiscard]] PlanOptions plan_options() const {
    const MeshOptions::Parts& parts = options_.parts;
    PlanOptions plan;
    plan.mapping = {transport_.ranks(), parts.speeds, mapping_method(parts.mapping),
                    parts.map_by_area ? MappingWeight::kArea : MappingWeight::kWork};
    plan.presplit = presplit_mode(parts.presplit);
    plan.aggregation = parts.aggregation;
    plan.order = work_order(parts.order);
    plan.sleep = parts.sleep;
    plan.balancing.policy = parts.policy;
    for (const std::string& parameter : parts.policy_parameters) {
      const std::size_t equals = parameter.find('=');
      if (equals == std::string::npos)
        throw Error("--balance-with takes NAME=VALUE, as in method=graph, not '" + parameter + "'");
      plan.balancing.parameters[parameter.substr(0, equals)] = parameter.substr(equals + 1);
    }
    if (!parts.drag.empty() && parts.drag.size() != static_cast<std::size_t>(transport_.ranks()))
      throw Error(fmt::format("--drag has {} fractions for {} ranks", parts.drag.size(), transport_.ranks()));
    return plan;
  }

  /// The share of its time that this rank works.
  [[nodiscard]] double own_share() const {
    const std::vector<double>& shares = options_.parts.drag;
    return shares.empty() ? 1 : shares[static_cast<std::size_t>(transport_.rank())];
  }

  void refine() {
    limits_ = find_limits(options_, pslg_, ranks_on_machine_);
    plan_.max_triangles = limits_.triangles;
    double forecast = 0;
    for (std::size_t s = 0; s < plan_.owners.size(); ++s)
      if (plan_.owners[s] == transport_.rank()) forecast += plan_.decomposition.subdomains[s].predicted;
    RankLoop::Observers observers;
    observers.stalled = [](const std::string& why) { fmt::print(stderr, "driftmesh: {}\n", why); };
    observers.after_slice = [&, share = own_share()](const RankLoop& loop, const RankLoop::Slice& slice) {
      if (leader_) notes_.progress.refining(loop.triangles(), forecast);
      drag(share, slice.seconds);
    };
    notes_.timed("refine", [&] {
      council_ = balancer::make_mpi_council(transport_, plan_.layout, plan_.policy, plan_.balancing.options);
      loop_.emplace(transport_, plan_, CostModel{}, observers, council_.get());
      protocol::run_rank(transport_, [&] { return loop_->step(); });
    });
  }

  void report() {
    ByteWriter writer;
    notes_.timed("inspect", [&] {
      RankReport own = report_of(*loop_, plan_);
      own.rank.peak = peak_memory();
      own.write(writer);
    });
    for (const Bytes& bytes : transport_.gather(writer.take())) {
      ByteReader reader(bytes);
      add_report(run_, RankReport::read(reader));
    }
    add_plan(run_, plan_);
  }

  [[nodiscard]] HeldSubdomains held() const { return held_by_rank(loop_->subdomains()); }

  void write() {
    protocol::MpiTransport transport(protocol::MpiSession::world());
    ExchangeRunner ranks(transport);
    const DistributedPiece piece = notes_.timed("assemble", [&] {
      PieceAssembly assembly(transport.rank(), transport.ranks(), plan_.decomposition, held());
      ranks.run(assembly);
      return assembly.piece(pslg_);
    });
    loop_.reset();
    notes_.timed("write", [&] { write_distributed(ranks, piece, options_.outputs, {pslg_.holes}); });
    if (!options_.picture.empty()) plot(ranks, piece);
    transport.close();
    if (!leader_) return;
    for (const std::string& output : options_.outputs)
      for (const std::string& file : files_of_output(output, transport_.ranks())) notes_.note_file(file);
    if (!options_.picture.empty()) notes_.note_file(options_.picture);
  }

  void plot(ExchangeRunner& ranks, const DistributedPiece& piece) {
    notes_.timed("plot", [&] {
      GatherPieces gathering(piece);
      ranks.run(gathering);
      const std::string title = std::filesystem::path(options_.input).filename().string();
      if (leader_) plot_mesh(gathering.whole(), options_.picture, {.title = title});
    });
  }

  const MeshOptions& options_;
  protocol::MpiTransport& transport_;
  bool leader_;
  int ranks_on_machine_ = 1;
  RunNotes notes_;
  RunRecord& run_;
  std::unique_ptr<SizeField> size_;
  Limits limits_;
  RunPlan plan_;
  Pslg pslg_;
  std::unique_ptr<balancer::Council> council_;  // if the policy asks for one
  std::optional<RankLoop> loop_;
};

}  // namespace

int mesh_in_parts(const MeshOptions& options, const std::string& command) {
  int argc = 0;
  char** argv = nullptr;
  const protocol::MpiSession session(argc, argv);
  protocol::MpiTransport transport(protocol::MpiSession::world());
  const std::string start = transport.ranks() > 1 ? fmt::format("mpirun -n {} ", transport.ranks()) : "";
  const int code = ParallelMesh(options, start + command, transport).go();
  if (code == 0) transport.close();
  return code;
}

}  // namespace driftmesh::app
