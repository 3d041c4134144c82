#include "app/experiment_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "app/decomposition_picture.hpp"
#include "base/words.hpp"
#include "cluster/cluster_spec.hpp"
#include "job/domain.hpp"
#include "job/value.hpp"
#include "picture/plot.hpp"
#include "picture/plot_chart.hpp"

namespace driftmesh::app {
namespace {

constexpr Rgb kComputing{0.25, 0.47, 0.70}, kSending{0.95, 0.61, 0.20}, kPolling{0.93, 0.82, 0.35},
    kBalancing{0.78, 0.28, 0.33}, kIdle{0.86, 0.87, 0.89};

constexpr const char *kTimePicture = "-time.png", *kLoadPicture = "-load.png", *kBeforePicture = "-owners-before.png",
                     *kAfterPicture = "-owners-after.png", *kMovesPicture = "-moves.png";

std::string swept_words(const ExperimentRun& run) {
  std::string words;
  for (const auto& [key, value] : run.swept) words += fmt::format(", {} {}", key, job::text_of(value));
  return words;
}

ChartText text_of(const ExperimentRun& run, std::string title) {
  return {std::move(title),
          fmt::format("{}{}: {} triangles on {} ranks in {}", run.request.name, swept_words(run),
                      grouped(run.outcome.triangles()), run.outcome.ranks.size(), duration_words(run.outcome.makespan)),
          "", ""};
}

void draw_times(const ExperimentRun& run, const std::string& path) {
  StackedBars bars;
  bars.text = text_of(run, "Time of each rank");
  bars.text.x_label = "rank";
  bars.text.y_label = "seconds";
  bars.parts = {{"computing", kComputing, {}},
                {"sending", kSending, {}},
                {"polling", kPolling, {}},
                {"balancing", kBalancing, {}},
                {"idle", kIdle, {}}};
  for (const RankOutcome& rank : run.outcome.ranks) {
    const RankTimes& t = rank.times;
    const double busy = t.computing + t.sending + t.polling + t.balancing;
    const double heights[] = {t.computing, t.sending, t.polling, t.balancing,
                              std::max(run.outcome.makespan - busy, 0.0)};
    for (std::size_t i = 0; i < bars.parts.size(); ++i) bars.parts[i].heights.push_back(heights[i]);
  }
  for (const RankGroup& group : run.request.cluster.groups)
    bars.groups.push_back({group.name, static_cast<std::size_t>(group.ranks)});
  plot_chart(bars, path);
}

/// Expected seconds of work left per rank over time: mean, minimum and maximum.
void draw_load(const ExperimentRun& run, const std::string& path) {
  const ClusterRun& outcome = run.outcome;
  LineChart chart;
  chart.text = text_of(run, "Work left per rank over time");
  chart.text.x_label = "seconds";
  chart.text.y_label = "expected seconds of work";
  LineChart::Curve band{"minimum to maximum of all ranks", {0.80, 0.86, 0.93}, {}, {}};
  LineChart::Curve mean{"mean", kComputing, {}, {}};
  IdVector<Rank, double> left(outcome.ranks.size(), 0);
  const auto take = [&](const LoadSample& s) { left[s.rank] = s.remaining / run.speeds[s.rank]; };
  std::for_each(outcome.samples.rbegin(), outcome.samples.rend(), take);  // at first, what the first ones say
  constexpr int kColumns = 300;
  std::size_t next = 0;
  for (int column = 0; column <= kColumns; ++column) {
    const double time = outcome.makespan * column / kColumns;
    for (; next < outcome.samples.size() && outcome.samples[next].time <= time; ++next) take(outcome.samples[next]);
    double sum = 0;
    for (const double seconds : left) sum += seconds;
    const auto [least, most] = std::minmax_element(left.begin(), left.end());
    band.points.push_back({time, *most});
    band.low.push_back(*least);
    mean.points.push_back({time, sum / static_cast<double>(left.size())});
  }
  chart.curves = {std::move(band), std::move(mean)};
  plot_chart(chart, path);
}

void draw_moves(const ExperimentRun& run, const std::string& path) {
  Timeline timeline;
  timeline.text = text_of(run, fmt::format("{} subdomains move while the ranks work", run.outcome.moves.size()));
  timeline.text.x_label = "seconds";
  timeline.text.y_label = "rank; blue: at work, red: a subdomain moves";
  timeline.rows = run.outcome.ranks.size();
  timeline.end = run.outcome.makespan;
  timeline.busy.resize(timeline.rows);
  for (const LoadSample& s : run.outcome.samples)
    if (s.worked > 0) timeline.busy[to_index(s.rank)].push_back({s.time - s.worked, s.time});
  for (const MoveRecord& m : run.outcome.moves)
    timeline.arrows.push_back({m.left, m.arrived, to_index(m.from), to_index(m.to)});
  plot_chart(timeline, path);
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace

void draw_run(const ExperimentRun& run, const std::string& folder) {
  const std::string stem = folder + "/" + run.name;
  draw_times(run, stem + kTimePicture);
  if (run.plan.owners.empty()) return;  // a method without subdomains
  draw_load(run, stem + kLoadPicture);
  plot_owners(run.plan.decomposition, run.plan.owners, stem + kBeforePicture,
              run.request.name + ": subdomains by rank, at the start");
  if (run.outcome.owners != run.plan.owners)
    plot_owners(run.plan.decomposition, run.outcome.owners, stem + kAfterPicture,
                run.request.name + ": subdomains by rank, at the end");
  if (!run.outcome.moves.empty()) draw_moves(run, stem + kMovesPicture);
}

std::vector<std::string> pictures_of_run(const std::string& name) {
  std::vector<std::string> files;
  for (const char* picture : {kTimePicture, kLoadPicture, kBeforePicture, kAfterPicture, kMovesPicture})
    files.push_back(name + picture);
  return files;
}

void draw_sweep(const ExperimentTable& table, const std::string& title, const std::string& folder) {
  LineChart::Curve efficiency{"efficiency", kComputing, {}, {}, true};
  LineChart::Curve communication{"fraction of sending and polling", kSending, {}, {}, true};
  for (const ExperimentTable::Row& row : table.rows()) {
    const std::optional<double> x = row.swept.size() == 1 ? number_of(row.swept[0].second) : std::nullopt;
    if (!x) return;
    efficiency.points.push_back({*x, row.efficiency});
    communication.points.push_back({*x, row.times.sending + row.times.polling});
  }
  if (efficiency.points.size() < 2) return;
  const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
  std::stable_sort(efficiency.points.begin(), efficiency.points.end(), by_x);
  std::stable_sort(communication.points.begin(), communication.points.end(), by_x);
  LineChart chart;
  chart.text = {title, "ideal time over time", table.rows().front().swept[0].first, ""};
  chart.logarithmic_x =
      efficiency.points.front().x > 0 && efficiency.points.back().x >= 10 * efficiency.points.front().x;
  chart.curves = {std::move(efficiency), std::move(communication)};
  plot_chart(chart, folder + "/" + kSweepPicture);
}

}  // namespace driftmesh::app
