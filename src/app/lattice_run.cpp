#include "app/lattice_run.hpp"

#include <memory>
#include <utility>

#include "base/stopwatch.hpp"
#include "job/memory.hpp"
#include "job/rank_report.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/interpolate_attributes.hpp"
#include "pdr/gather_cells.hpp"
#include "pdr/lattice_refinement.hpp"
#include "pdr/start.hpp"

namespace driftmesh::app {
namespace {

using job::timed;

/// One rank's mesh and its part in the refinement.
struct LatticePart {
  Triangulation mesh;
  pdr::Lattice lattice;
  pdr::LatticeRefinement refinement;

  LatticePart(const job::Team& team, Triangulation&& triangulated, const QualityBounds& bounds)
      : mesh(std::move(triangulated)),
        lattice(pdr::start(mesh, bounds, team.ranks())),
        refinement(team.rank(), team.ranks(), mesh, bounds, lattice) {}
};

job::RankReport lattice_report(const LatticePart& part, const QualityBounds& bounds, double seconds) {
  job::RankReport report;
  job::add_part(report.facts, part.mesh, bounds, true);
  job::add_counters(report.facts, part.refinement.cells().counters());
  const auto& traffic = part.refinement.traffic();
  report.rank.triangles = report.facts.triangles;
  report.rank.times.computing = traffic.seconds_computing;
  report.rank.times.idle = seconds - traffic.seconds_computing;
  report.rank.counters.splits_sent = traffic.points;
  report.rank.counters.batches_sent = traffic.messages;
  report.rank.messages = static_cast<std::uint64_t>(traffic.messages);
  report.rank.message_bytes = static_cast<std::uint64_t>(traffic.bytes);
  report.rank.peak = job::peak_memory();
  return report;
}

void gather_reports(job::Team& team, const job::RankReport& own, job::RunRecord& run) {
  ByteWriter writer;
  own.write(writer);
  for (const Bytes& bytes : team.gather(writer.take())) {
    ByteReader reader(bytes);
    job::add_report(run, job::RankReport::read(reader));
  }
}

}  // namespace

Mesh mesh_on_lattice(job::Team& team, const Pslg& pslg, const QualityBounds& bounds, RunNotes& notes) {
  const std::unique_ptr<job::Channel> channel = team.open();
  Mesh whole;
  job::by_itself(team, [&] {
    ExchangeRunner ranks(channel->transport());
    Triangulation mesh = triangulate(pslg);
    notes.run.acute_corners = prepare_corners(mesh, {bounds.min_angle, false});
    const auto part =
        timed(notes, "start", [&] { return std::make_unique<LatticePart>(team, std::move(mesh), bounds); });
    const Stopwatch refining;
    timed(notes, "refine", [&] { ranks.run(part->refinement); });
    const double seconds = refining.seconds();
    timed(notes, "assemble", [&] {
      pdr::GatherCells gathering(
          team.rank(), team.ranks(),
          pdr::own_triangles(part->mesh, pslg, part->refinement.cells(), part->lattice, team.rank()));
      ranks.run(gathering);
      whole = std::move(gathering.whole());
      if (team.leads()) interpolate_attributes(pslg, whole);
    });
    pdr::keep_own_triangles(part->mesh, part->refinement.cells(), part->lattice, team.rank());
    gather_reports(team, lattice_report(*part, bounds, seconds), notes.run);
  });
  channel->close();
  notes.run.vertices = static_cast<std::int64_t>(whole.points.size());
  notes.run.subsegments = static_cast<std::int64_t>(whole.edges.size());
  return whole;
}

}  // namespace driftmesh::app
