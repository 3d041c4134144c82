#include "app/experiment_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/words.hpp"
#include "job/value.hpp"

namespace driftmesh::app {
namespace {

using Row = ExperimentTable::Row;
using Cells = std::vector<std::pair<std::string, std::string>>;  // column, value

/// How all ranks spent their time, as fractions. Waiting after a rank has left the loop is idle time too.
RankTimes shares_of(const ClusterRun& outcome) {
  RankTimes sum;
  for (const RankOutcome& rank : outcome.ranks) {
    sum.computing += rank.times.computing;
    sum.sending += rank.times.sending;
    sum.polling += rank.times.polling;
    sum.balancing += rank.times.balancing;
  }
  const double whole = outcome.makespan * static_cast<double>(outcome.ranks.size());
  for (double RankTimes::*kind :
       {&RankTimes::computing, &RankTimes::sending, &RankTimes::polling, &RankTimes::balancing})
    sum.*kind /= whole;
  sum.idle = 1 - sum.computing - sum.sending - sum.polling - sum.balancing;
  return sum;
}

/// Whether two runs are at the same point of the sweep except for the policy.
bool same_but_policy(const Row& a, const Row& b) {
  return std::equal(a.swept.begin(), a.swept.end(), b.swept.begin(), b.swept.end(), [](const auto& x, const auto& y) {
    return x == y || (x.first == y.first && x.first == "balance.policy");
  });
}

Cells swept_cells(const Row& row, bool repeated) {
  Cells cells(row.swept.begin(), row.swept.end());
  if (repeated) cells.emplace_back("repetition", std::to_string(row.repetition));
  return cells;
}

Cells all_cells(const Row& row, std::optional<double> recovered) {
  Cells cells{{"run", row.run}};
  for (auto& cell : swept_cells(row, true)) cells.push_back(std::move(cell));
  const auto add = [&](const char* name, const auto& value) { cells.emplace_back(name, fmt::format("{}", value)); };
  add("ranks", row.ranks);
  add("subdomains", row.subdomains);
  add("triangles", row.triangles);
  add("seconds", row.seconds);
  add("ideal_seconds", row.ideal_seconds);
  add("triangles_per_second", row.rate);
  add("efficiency", row.efficiency);
  add("cutting_seconds", row.cutting);
  add("efficiency_with_cutting", row.efficiency_with_cutting);
  cells.emplace_back("recovered", recovered ? fmt::format("{}", *recovered) : "");
  add("computing", row.times.computing);
  add("sending", row.times.sending);
  add("polling", row.times.polling);
  add("balancing", row.times.balancing);
  add("idle", row.times.idle);
  add("splits", row.splits);
  add("split_messages", row.split_messages);
  add("messages", row.messages);
  add("message_bytes", row.message_bytes);
  add("hand_offs", row.hand_offs);
  add("hand_off_bytes", row.hand_off_bytes);
  return cells;
}

/// `recovered`: its text, if the table has this column.
Cells telling_cells(const Row& row, bool repeated, const std::optional<std::string>& recovered) {
  Cells cells = swept_cells(row, repeated);
  const bool ranks_swept =
      std::any_of(row.swept.begin(), row.swept.end(), [](const auto& s) { return s.first == "cluster.ranks"; });
  const auto add = [&](const char* name, std::string value) { cells.emplace_back(name, std::move(value)); };
  const auto percent = [&](const char* name, double share) { add(name, fmt::format("{:.2f}", 100 * share)); };
  if (!ranks_swept) add("ranks", grouped(static_cast<std::int64_t>(row.ranks)));
  add("triangles", grouped(row.triangles));
  add("seconds", fmt::format("{:.4g}", row.seconds));
  add("million/s", fmt::format("{:.4g}", 1e-6 * row.rate));
  add("efficiency", fmt::format("{:.3f}", row.efficiency));
  if (recovered) add("recovered %", *recovered);
  percent("computing %", row.times.computing);
  percent("sending %", row.times.sending);
  percent("polling %", row.times.polling);
  percent("balancing %", row.times.balancing);
  percent("idle %", row.times.idle);
  add("SPLITs", grouped(row.splits));
  add("in messages", grouped(row.split_messages));
  add("moved", grouped(row.hand_offs));
  return cells;
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string line_of(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) line += fmt::format(" {:>{}} |", cells[i], widths[i]);
  return line + "\n";
}

}  // namespace

void ExperimentTable::add(const ExperimentRun& run) {
  Row row;
  row.run = run.name;
  for (const auto& [key, value] : run.swept) row.swept.emplace_back(key, job::text_of(value));
  row.repetition = run.repetition;
  row.policy = run.request.balance.policy;
  row.ranks = run.outcome.ranks.size();
  row.subdomains = run.outcome.owners.size();
  row.triangles = run.outcome.triangles();
  row.seconds = run.outcome.makespan;
  row.ideal_seconds = run.ideal;
  row.rate = static_cast<double>(row.triangles) / row.seconds;
  const double for_speed = row.rate / std::accumulate(run.speeds.begin(), run.speeds.end(), 0.0);
  row.cutting = run.outcome.cutting;
  const double with_cutting = for_speed * row.seconds / (row.seconds + row.cutting);
  if (rows_.empty()) {
    first_rate_ = for_speed;
    first_rate_with_cutting_ = with_cutting;
  }
  row.efficiency = for_speed / first_rate_;
  row.efficiency_with_cutting = with_cutting / first_rate_with_cutting_;
  row.times = shares_of(run.outcome);
  for (const RankOutcome& rank : run.outcome.ranks) {
    row.splits += rank.counters.splits_sent;
    row.split_messages += rank.counters.batches_sent;
    row.hand_offs += rank.counters.hand_offs;
    row.hand_off_bytes += rank.counters.hand_off_bytes;
  }
  row.messages = run.outcome.messages();
  row.message_bytes = run.outcome.message_bytes();
  rows_.push_back(std::move(row));
}

std::optional<double> ExperimentTable::recovered(const Row& row) const {
  if (row.policy == "none") return {};
  const auto without = std::find_if(rows_.begin(), rows_.end(), [&](const Row& other) {
    return other.policy == "none" && other.repetition == row.repetition && same_but_policy(other, row);
  });
  if (without == rows_.end()) return {};
  const double possible = without->seconds - without->ideal_seconds;
  if (!(possible > 0)) return {};
  return (without->seconds - row.seconds) / possible;
}

std::string ExperimentTable::csv() const {
  std::string text;
  for (const Row& row : rows_) {
    std::vector<std::string> columns, values;
    for (const auto& [column, value] : all_cells(row, recovered(row))) {
      columns.push_back(csv_quoted(column));
      values.push_back(csv_quoted(value));
    }
    if (text.empty()) text = fmt::format("{}\n", fmt::join(columns, ","));
    text += fmt::format("{}\n", fmt::join(values, ","));
  }
  return text;
}

std::string ExperimentTable::markdown() const {
  const bool repeated = std::any_of(rows_.begin(), rows_.end(), [](const Row& row) { return row.repetition > 0; });
  const bool saved =
      std::any_of(rows_.begin(), rows_.end(), [&](const Row& row) { return recovered(row).has_value(); });
  std::vector<std::vector<std::string>> lines;
  for (const Row& row : rows_) {
    std::optional<std::string> share;
    if (saved) share = recovered(row) ? fmt::format("{:.1f}", 100 * *recovered(row)) : "";
    const Cells cells = telling_cells(row, repeated, share);
    if (lines.empty()) lines.resize(1);
    lines.emplace_back();
    for (const auto& [column, value] : cells) {
      if (lines.size() == 2) lines[0].push_back(column);
      lines.back().push_back(value);
    }
  }
  if (lines.empty()) return "";
  std::vector<std::size_t> widths(lines[0].size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += line_of(lines[i], widths);
    if (i > 0) continue;
    text += "|";
    for (const std::size_t width : widths) text += std::string(width + 1, '-') + ":|";
    text += "\n";
  }
  return text;
}

}  // namespace driftmesh::app
