#include "api/driftmesh.hpp"

#include <functional>
#include <span>
#include <string>
#include <utility>

#include "balancer/mpi/mpi_council.hpp"
#include "base/byte_stream.hpp"
#include "base/error.hpp"
#include "decompose/same_input.hpp"
#include "distributed/assembly.hpp"
#include "distributed/write_distributed.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/mesher.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "pslg/repair.hpp"
#include "runtime/plan_bytes.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh {
namespace {

using protocol::Bytes;
using protocol::MpiSession;
using protocol::MpiTransport;

/// What all ranks start from.
struct Start {
  RunPlan plan;
  Pslg input;
};

using MakeDecomposition = std::function<Decomposition(const Pslg& repaired, const QualityBounds&, int ranks)>;

Start plan(const Pslg& input, const MakeDecomposition& decomposition, const DistributedOptions& options, int ranks) {
  Start start;
  start.input = input;
  static_cast<void>(repair(start.input));
  const MeshRequest request{options.min_angle, options.max_area, options.region_areas, options.size};
  const QualityBounds bounds = bounds_of(start.input, request);
  PlanOptions how;
  how.mapping.ranks = ranks;
  how.mapping.method = mapping_method(options.mapping);
  how.presplit = presplit_mode(options.presplit);
  how.balancing.policy = options.balance;
  start.plan = plan_run(decomposition(start.input, bounds, ranks), bounds, how);
  return start;
}

/// The others wait for a rank that fails here, so it takes them with it.
template <class Work>
auto or_end_the_job(const MpiTransport& transport, const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    MpiSession::abort("driftmesh: rank " + std::to_string(transport.rank()) + ": " + error.what());
  }
}

/// What rank 0 makes, on all ranks; or what it throws.
Start share(MpiTransport& transport, const std::function<Start()>& make) {
  std::string error;
  ByteWriter writer;
  if (transport.rank() == 0) {
    try {
      const Start start = make();
      writer.text(error);
      writer.array(plan_to_bytes(start.plan));
      writer.array(pslg_to_bytes(start.input));
    } catch (const std::exception& e) {
      error = e.what();
      writer = {};
      writer.text(error);
    }
  }
  const Bytes bytes = transport.broadcast(writer.take());
  ByteReader reader(bytes);
  error = reader.text();
  if (!error.empty()) throw Error(error);
  return or_end_the_job(transport, [&]() -> Start {
    Bytes plan_bytes, input_bytes;
    reader.array(plan_bytes);
    reader.array(input_bytes);
    return {plan_from_bytes(plan_bytes, transport.ranks()), pslg_from_bytes(input_bytes)};
  });
}

DistributedPiece refine(MpiTransport& transport, int communicator, const Start& start) {
  return or_end_the_job(transport, [&] {
    const RunPlan& plan = start.plan;
    const auto council = balancer::make_mpi_council(transport, plan.layout, plan.policy, plan.balancing.options);
    RankLoop loop(transport, plan, CostModel{}, {}, council.get());
    protocol::run_rank(transport, [&] { return loop.step(); });
    MpiTransport afterwards(communicator);  // messages of ranks that are still at work do not reach it
    ExchangeRunner ranks(afterwards);
    PieceAssembly assembly(transport.rank(), transport.ranks(), plan.decomposition, held_by_rank(loop.subdomains()));
    ranks.run(assembly);
    afterwards.close();
    return assembly.piece(start.input);
  });
}

DistributedPiece make(int communicator, const Pslg& input, const MakeDecomposition& decomposition,
                      const DistributedOptions& options) {
  MpiTransport transport(communicator);
  Start start;
  try {
    start = share(transport, [&] { return plan(input, decomposition, options, transport.ranks()); });
  } catch (const std::exception&) {
    transport.close();
    throw;
  }
  start.plan.bounds.size = options.size;
  DistributedPiece piece = refine(transport, communicator, start);
  transport.close();
  return piece;
}

}  // namespace

DistributedPiece mesh_distributed(int communicator, const Pslg& input, const DistributedOptions& options) {
  const auto decompose_input = [&](const Pslg& repaired, const QualityBounds& bounds, int ranks) {
    Triangulation mesh = triangulate(repaired);
    prepare_corners(mesh);
    DecomposeOptions cutting;
    cutting.subdomains = options.subdomains;
    cutting.bounds = bounds;
    return decompose_for(mesh, cutting, ranks);
  };
  return make(communicator, input, decompose_input, options);
}

DistributedPiece mesh_distributed(int communicator, const Pslg& input, const Decomposition& decomposition,
                                  const DistributedOptions& options) {
  const auto given = [&](const Pslg& repaired, const QualityBounds&, int) {
    require_same_input(decomposition, repaired, "the decomposition");
    return decomposition;
  };
  return make(communicator, input, given, options);
}

void write_distributed(int communicator, const DistributedPiece& piece, const std::string& path) {
  MpiTransport transport(communicator);
  ExchangeRunner ranks(transport);
  try {
    write_distributed(ranks, piece, std::span(&path, 1));
  } catch (const std::exception&) {
    transport.close();
    throw;
  }
  transport.close();
}

}  // namespace driftmesh
