#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "app/summary.hpp"
#include "base/words.hpp"
#include "io/mesh_file.hpp"
#include "job/files.hpp"
#include "protocol/counter_sum.hpp"

namespace driftmesh::app {
namespace {

using Text = std::back_insert_iterator<std::string>;

/// "1 hole", "26 holes"
std::string counted(std::int64_t n, const char* what) {
  return fmt::format("{} {}{}", grouped(n), what, n == 1 ? "" : "s");
}

std::int64_t repair_count(const RepairReport& r) {
  std::int64_t count = 0;
  for (const RepairItem* item :
       {&r.rounded_points, &r.duplicate_points, &r.close_points, &r.zero_length_segments, &r.duplicate_segments,
        &r.points_on_segments, &r.points_close_segments, &r.crossings, &r.overlaps, &r.collapsed})
    count += item->count;
  return count;
}

/// The narrowest ones.
void add_creeks(const RunRecord& run, Text out) {
  constexpr std::size_t kMost = 5;
  if (run.creeks.empty()) return;
  const std::size_t listed = run.creeks.size() <= kMost + 1 ? run.creeks.size() : kMost;
  fmt::format_to(out, "too narrow   {} for {} layers of triangles of {:g}, --size-min:\n",
                 counted(static_cast<std::int64_t>(run.creeks.size()), "creek"), run.request.sizing.across,
                 run.request.sizing.shortest);
  for (const Creek& creek : std::span(run.creeks).first(listed))
    fmt::format_to(out, "             {:.6g} wide at ({:.9g}, {:.9g}), {:.6g} long\n", creek.width, creek.at.x,
                   creek.at.y, creek.length);
  if (listed < run.creeks.size())
    fmt::format_to(out, "             and {} more, of which --json writes all\n",
                   grouped(static_cast<std::int64_t>(run.creeks.size() - listed)));
}

void add_input(const RunRecord& run, Text out) {
  fmt::format_to(out, "input        {}: {}, {}, {}, {}\n", run.input_file, counted(run.input_points, "point"),
                 counted(run.input_segments, "segment"), counted(run.input_holes, "hole"),
                 counted(run.input_regions, "region"));
  if (!run.projection.empty()) fmt::format_to(out, "             in meters, {}\n", run.projection);
  if (const std::int64_t n = repair_count(run.repairs); n > 0)
    fmt::format_to(out, "             after {}\n", counted(n, "repair"));
  if (run.request.input.simplify > 0)
    fmt::format_to(out, "             simplified by up to {:g}: without {} and {}\n", run.request.input.simplify,
                   counted(run.simplified.points, "point"), counted(run.simplified.rings, "small ring"));
  if (run.request.input.close_channels > 0)
    fmt::format_to(out, "             without {} narrower than {:g}, with an area of {:.6g}{}\n",
                   counted(run.closed.channels, "channel"), run.request.input.close_channels, run.closed.area,
                   run.closed.parts > 1 ? fmt::format(": {} parts are left", grouped(run.closed.parts)) : "");
  add_creeks(run, out);
  const char* label = "warnings";
  for (const std::string& warning : run.warnings) {
    fmt::format_to(out, "{:<12} {}\n", label, warning);
    label = "";
  }
}

void add_mesh(const RunRecord& run, Text out) {
  fmt::format_to(out, "mesh         {}, {}, {}\n", counted(run.triangles, "triangle"),
                 run.vertices == 1 ? "1 vertex" : grouped(run.vertices) + " vertices",
                 counted(run.subsegments, "subsegment"));
  if (!run.complete)
    fmt::format_to(out, "             INCOMPLETE: stopped by {}\n", job::called(run.stopped_by, job::kMesh));
  fmt::format_to(out, "angles       {:.4f} to {:.4f} degrees", run.shape.smallest, run.shape.largest);
  if (run.min_angle > 0) fmt::format_to(out, "; at least {} requested", run.min_angle);
  fmt::format_to(out, "\nareas        {:.6g} to {:.6g}", run.shape.smallest_area, run.shape.largest_area);
  if (run.max_area > 0) fmt::format_to(out, "; at most {:.10g} requested", run.max_area);
  fmt::format_to(out, "; {:.10g} in total\n", run.shape.total_area);
  if (!run.sizing.empty()) fmt::format_to(out, "edge length  {}\n", run.sizing);
}

void add_exceptions(const RunRecord& run, Text out) {
  if (run.exceptions.empty()) {
    fmt::format_to(out, "exceptions   none\n");
    return;
  }
  const char* label = "exceptions";
  for (const RunRecord::ExceptionGroup& group : run.exceptions) {
    fmt::format_to(out, "{:<12} {}, {}", label, counted(group.count, "triangle"), group.cause);
    if (group.worst_angle < 180) fmt::format_to(out, ", from {:.4f} degrees", group.worst_angle);
    fmt::format_to(out, "\n             at");
    for (const auto& p : group.places) fmt::format_to(out, " ({:.9g}, {:.9g})", p.at.x, p.at.y);
    constexpr std::size_t kMax = RunRecord::ExceptionGroup::kMaxPlaces;
    const bool all_listed = group.places.size() < kMax || group.count == static_cast<std::int64_t>(kMax);
    fmt::format_to(out, "{}\n", all_listed ? "" : " ...");
    label = "";
  }
}

const char* cause_words(StepCause cause) {
  switch (cause) {
    case StepCause::kSegment:
      return "at short segments of the input";
    case StepCause::kHalf:
      return "at segments that angles have split";
    case StepCause::kBetween:
      return "between points on segments";
    case StepCause::kAngles:
      break;
  }
  return "where angles or sizes leave no choice";
}

/// A length of two digits, rounded up.
double rounded_up(double length) {
  const double digit = std::pow(10, std::floor(std::log10(length)) - 1);
  return std::ceil(length / digit) * digit;
}

void add_step(const RunRecord& run, Text out) {
  const job::Request::Sizing& asked = run.request.sizing;
  if (asked.courant_step == 0 || run.triangles == 0) return;
  const job::MeshFacts::Step& step = run.step;
  fmt::format_to(out, "time step    {:.4g} s holds (Courant {:g})", asked.courant_step * step.least_room,
                 asked.courant);
  fmt::format_to(out, "; {:g} s requested\n", asked.courant_step);
  if (step.misses() > 0) fmt::format_to(out, "             too long for {}\n", counted(step.misses(), "triangle"));
  for (std::size_t k = 0; k < step.groups.size(); ++k) {
    const auto& group = step.groups[k];
    if (group.count == 0) continue;
    fmt::format_to(out, "             {} {}:", grouped(group.count), cause_words(static_cast<StepCause>(k)));
    for (std::size_t i = 0; i < std::min(group.places.size(), static_cast<std::size_t>(group.count)); ++i)
      fmt::format_to(out, " {:.3g} s at ({:.9g}, {:.9g})", asked.courant_step * group.places[i].room,
                     group.places[i].at.x, group.places[i].at.y);
    fmt::format_to(out, "{}\n", group.count > static_cast<std::int64_t>(group.places.size()) ? " ..." : "");
  }
  const auto hint = [&](StepCause cause, const char* option) {
    const auto& group = step.groups[static_cast<std::size_t>(cause)];
    if (group.count > 0)
      fmt::format_to(out, "             a coarser outline: {} {:g}\n", option, rounded_up(group.longest_needed));
  };
  hint(StepCause::kSegment, "--simplify");
  hint(StepCause::kBetween, "--snap");
}

/// All of the time and that of stages, without the end of the last line.
std::string time_lines(const RunRecord& run) {
  constexpr std::size_t kWidth = 100;
  std::string lines = "time         " + duration_words(run.seconds);
  const char* separator = ":";
  std::size_t begin = 0;  // where the last line begins
  for (const job::StageTime& stage : run.stages) {
    if (stage.seconds < 0.0005) continue;
    const std::string item = fmt::format("{} {:.3f}", stage.name, stage.seconds);
    lines += separator;
    if (lines.size() - begin + item.size() + 2 > kWidth) {
      lines += '\n';
      begin = lines.size();
      lines += "            ";
    }
    lines += ' ' + item;
    separator = ",";
  }
  return lines;
}

void add_work(const RunRecord& run, Text out) {
  if (run.seconds_refine > 0.02)  // below that, clock resolution dominates
    fmt::format_to(out, "refinement   {} triangles per second\n", rate_words(run.triangles_per_second()));
  fmt::format_to(out, "{}", time_lines(run));
  const auto per_triangle = [&](std::uint64_t bytes) {
    return static_cast<double>(bytes) / static_cast<double>(std::max<std::int64_t>(1, run.triangles));
  };
  fmt::format_to(out, "\nmemory       peak {}, while refining {}", bytes_words(run.peak),
                 bytes_words(run.peak_refining));
  if (run.triangles >= 1'000'000)  // below that, the program itself and its input dominate
    fmt::format_to(out, "; {:.1f} and {:.1f} bytes per triangle", per_triangle(run.peak),
                   per_triangle(run.peak_refining));
  fmt::format_to(out, "\n");
}

const char* rank_word(const RunRecord& run) {
  return run.on_threads ? "thread" : "rank";
}

/// One row per rank, or the extremes if there are many.
void add_rank_table(const RunRecord& run, Text out) {
  constexpr std::size_t kMostRows = 16;
  fmt::format_to(out, "  {:>8} {:>14} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", rank_word(run), "triangles",
                 "subdomains", "computing", "sending", "polling", "balancing", "idle");
  const auto row = [&](const std::string& name, const RunRecord::Rank& r) {
    fmt::format_to(out, "  {:>8} {:>14} {:>10} {:>8.3f} s {:>8.3f} s {:>8.3f} s {:>8.3f} s {:>8.3f} s\n", name,
                   grouped(r.triangles), r.subdomains, r.times.computing, r.times.sending, r.times.polling,
                   r.times.balancing, r.times.idle);
  };
  if (run.ranks.size() <= kMostRows) {
    for (std::size_t i = 0; i < run.ranks.size(); ++i) row(std::to_string(i), run.ranks[i]);
    return;
  }
  const auto by = [&](auto value, const char* what) {
    const auto [least, most] = std::minmax_element(run.ranks.begin(), run.ranks.end(),
                                                   [&](const auto& a, const auto& b) { return value(a) < value(b); });
    row(std::to_string(least - run.ranks.begin()), *least);
    row(std::to_string(most - run.ranks.begin()), *most);
    fmt::format_to(out, "           (minimum and maximum of {})\n", what);
  };
  by([](const RunRecord::Rank& r) { return r.triangles; }, "triangles");
  by([](const RunRecord::Rank& r) { return r.times.computing; }, "computing");
}

void add_ranks(const RunRecord& run, Text out) {
  if (run.ranks.empty()) return;
  protocol::ProtocolCounters sum;
  std::int64_t splits = 0;
  for (const RunRecord::Rank& r : run.ranks) {
    splits += r.interface_splits;
    sum += r.counters;
  }
  const std::int32_t threads = run.on_threads ? 1 : run.request.run.threads;
  if (run.request.run.method == job::Method::kPdr) {
    fmt::format_to(out, "parts        none: cells on {}, {} sent between them in {}\n",
                   counted(static_cast<std::int64_t>(run.ranks.size()), "rank"), counted(sum.splits_sent, "point"),
                   counted(sum.batches_sent, "message"));
    return add_rank_table(run, out);
  }
  fmt::format_to(out, "parts        {} on {}{}; interfaces {} before refinement\n",
                 counted(run.subdomains, "subdomain"),
                 counted(static_cast<std::int64_t>(run.ranks.size()), rank_word(run)),
                 threads > 1 ? fmt::format(" of {} threads", threads) : "", run.presplit ? "cut to size" : "not cut");
  fmt::format_to(out, "             {} put on interfaces by refinement, ", counted(splits, "split point"));
  if (run.rounds > 0)
    fmt::format_to(out, "in {}\n", counted(run.rounds, "round"));
  else
    fmt::format_to(out, "{} sent between ranks in {}\n", grouped(sum.splits_sent),
                   counted(sum.batches_sent, "message"));
  if (sum.hand_offs > 0)
    fmt::format_to(out, "             {} moved between {}s, {}\n", counted(sum.hand_offs, "subdomain"), rank_word(run),
                   bytes_words(static_cast<std::uint64_t>(sum.hand_off_bytes)));
  if (sum.forwarded > 0 || sum.held > 0)
    fmt::format_to(out, "             {} of split points forwarded after a subdomain, {} at most; {} held for one\n",
                   counted(sum.forwarded, "group"), counted(sum.most_hops, "hop"), grouped(sum.held));
  add_rank_table(run, out);
}

void add_checkpoints(const RunRecord& run, Text out) {
  const job::CheckpointRecord& kept = run.checkpoints;
  if (kept.count == 0) return;
  fmt::format_to(out, "kept         {} in {}, {}, which took {:.2f} s\n", counted(kept.count, "checkpoint"),
                 run.request.run.checkpoint, bytes_words(kept.bytes), kept.seconds);
}

void add_files(const RunRecord& run, Text out) {
  const char* label = "written";
  for (const RunRecord::File& file : run.files) {
    fmt::format_to(out, "{:<12} {}, {}\n", label, file.name, bytes_words(file.bytes));
    label = "";
  }
  const job::Request::Output& output = run.request.output;
  if (output.meshes.empty() && output.picture.empty() && output.session.empty())
    fmt::format_to(out, "written      no mesh; -o FILE writes one: {}\n", mesh_files_written());
  fmt::format_to(out, "digest       {:016x}\nrepeat       {}\n", run.digest, run.command);
}

}  // namespace

std::string histogram_text(const AngleSummary& shape) {
  constexpr double kBarLength = 50;
  const std::int64_t total =
      std::max<std::int64_t>(1, std::accumulate(shape.bins.begin(), shape.bins.end(), std::int64_t{0}));
  const auto most =
      static_cast<double>(std::max<std::int64_t>(1, *std::max_element(shape.bins.begin(), shape.bins.end())));
  std::string text;
  for (std::size_t i = 0; i < shape.bins.size(); ++i) {
    const auto count = static_cast<double>(shape.bins[i]);
    const auto length = static_cast<std::size_t>(std::ceil(kBarLength * count / most));  // every nonempty bin shows
    fmt::format_to(std::back_inserter(text), "  {:>3} - {:>3} {:>14}  {:>5.1f} %  {}", 10 * i, 10 * i + 10,
                   grouped(shape.bins[i]), 100 * count / static_cast<double>(total), std::string(length, '#'));
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string summary_text(const RunRecord& run) {
  std::string text;
  const auto out = std::back_inserter(text);
  add_input(run, out);
  add_mesh(run, out);
  text += histogram_text(run.shape);
  add_exceptions(run, out);
  add_step(run, out);
  add_work(run, out);
  add_ranks(run, out);
  add_checkpoints(run, out);
  add_files(run, out);
  return text;
}

}  // namespace driftmesh::app
