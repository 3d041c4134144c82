#include "study/experiment_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <system_error>

#include "base/from_chars.hpp"
#include "base/words.hpp"
#include "job/value.hpp"

namespace driftmesh::study {
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

Row row_without_figures(const ExperimentRun& run) {
  Row row;
  row.run = run.name;
  for (const auto& [key, value] : run.swept) row.swept.emplace_back(key, job::text_of(value));
  row.repetition = run.repetition;
  row.policy = run.request.balance.policy;
  return row;
}

/// Calls visit(column, value) for each figure that a row is made of; the others follow from them.
template <typename AnyRow, typename Visit>
void visit_figures(AnyRow& row, const Visit& visit) {
  visit("repetition", row.repetition);
  visit("ranks", row.ranks);
  visit("subdomains", row.subdomains);
  visit("triangles", row.triangles);
  visit("seconds", row.seconds);
  visit("ideal_seconds", row.ideal_seconds);
  visit("oracle_seconds", row.oracle_seconds);
  visit("triangles_per_second", row.rate);
  visit("efficiency", row.efficiency);
  visit("cutting_seconds", row.cutting);
  visit("efficiency_with_cutting", row.efficiency_with_cutting);
  visit("computing", row.times.computing);
  visit("sending", row.times.sending);
  visit("polling", row.times.polling);
  visit("balancing", row.times.balancing);
  visit("idle", row.times.idle);
  visit("splits", row.splits);
  visit("split_messages", row.split_messages);
  visit("messages", row.messages);
  visit("message_bytes", row.message_bytes);
  visit("hand_offs", row.hand_offs);
  visit("hand_off_bytes", row.hand_off_bytes);
  visit("whole_plans", row.whole_plans);
  visit("whole_plans_kept", row.whole_plans_kept);
}

Cells all_cells(const Row& row, std::optional<double> recovered) {
  Cells cells{{"run", row.run}};
  cells.insert(cells.end(), row.swept.begin(), row.swept.end());
  visit_figures(row, [&](const std::string& column, const auto& value) {
    cells.emplace_back(column, fmt::format("{}", value));
    if (column != "efficiency_with_cutting") return;
    cells.emplace_back("recovered", recovered ? fmt::format("{}", *recovered) : "");
    cells.emplace_back("regret", fmt::format("{}", regret(row)));
  });
  return cells;
}

/// Reads the figures again, from the text of each column. Returns false if one of them is missing or no number.
bool take_figures(Row& row, const std::map<std::string, std::string>& texts) {
  bool all = true;
  visit_figures(row, [&](const char* column, auto& value) {
    const auto found = texts.find(column);
    if (found == texts.end()) return void(all = false);
    const std::string& text = found->second;
    const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
    all = all && error == std::errc() && end == text.data() + text.size();
  });
  return all;
}

/// `saved`, `kept`: the texts of what is recovered and of whole plans, if the table has these columns.
Cells telling_cells(const Row& row, bool repeated, const std::optional<std::string>& saved,
                    const std::optional<std::string>& kept) {
  Cells cells(row.swept.begin(), row.swept.end());
  const auto add = [&](const char* name, std::string value) { cells.emplace_back(name, std::move(value)); };
  const auto percent = [&](const char* name, double share) { add(name, fmt::format("{:.2f}", 100 * share)); };
  if (std::ranges::none_of(row.swept, [](const auto& s) { return s.first == "cluster.ranks"; }))
    add("ranks", grouped(static_cast<std::int64_t>(row.ranks)));
  add("triangles", grouped(row.triangles));
  add("seconds", fmt::format("{:.4g}", row.seconds));
  if (repeated) add("+-", fmt::format("{:.2g}", row.spread));
  add("million/s", fmt::format("{:.4g}", 1e-6 * row.rate));
  add("efficiency", fmt::format("{:.3f}", row.efficiency));
  if (saved) add("recovered %", *saved);
  add("regret %", fmt::format("{:.1f}", 100 * regret(row)));
  percent("computing %", row.times.computing);
  percent("sending %", row.times.sending);
  percent("polling %", row.times.polling);
  percent("balancing %", row.times.balancing);
  percent("idle %", row.times.idle);
  add("SPLITs", grouped(row.splits));
  add("in messages", grouped(row.split_messages));
  add("moved", grouped(row.hand_offs));
  if (kept) add("whole plans kept", *kept);
  return cells;
}

/// Takes the columns that are the same in all of several rows out of them, but for the first ones and the time.
Cells take_common(std::vector<Cells>& rows, std::size_t first) {
  Cells common;
  for (std::size_t i = rows.size() < 2 ? rows.front().size() : first; i < rows.front().size();) {
    const auto cell = rows.front()[i];
    const bool same = std::ranges::all_of(rows, [&](const Cells& row) { return row[i] == cell; });
    if (!same || cell.first == "seconds") {
      ++i;
      continue;
    }
    common.push_back(cell);
    for (Cells& row : rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return common;
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// The cells of a line that csv_quoted() made; a line that breaks off has fewer.
std::vector<std::string> cells_of_csv(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  return cells;
}

std::string line_of(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) line += fmt::format(" {:>{}} |", cells[i], widths[i]);
  return line + "\n";
}

std::string markdown_of(const std::vector<Cells>& rows) {
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& [column, value] : rows.front()) lines[0].push_back(column);
  for (const Cells& row : rows) {
    lines.emplace_back();
    for (const auto& [column, value] : row) lines.back().push_back(value);
  }
  std::vector<std::size_t> widths(lines[0].size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text = line_of(lines[0], widths) + "|";
  for (const std::size_t width : widths) text += std::string(width + 1, '-') + ":|";
  text += "\n";
  for (std::size_t i = 1; i < lines.size(); ++i) text += line_of(lines[i], widths);
  return text;
}

}  // namespace

void ExperimentTable::add(const ExperimentRun& run) {
  Row row = row_without_figures(run);
  row.ranks = run.outcome.ranks.size();
  row.subdomains = run.outcome.owners.size();
  row.triangles = run.outcome.triangles();
  row.seconds = run.outcome.makespan;
  row.ideal_seconds = run.ideal;
  row.rate = static_cast<double>(row.triangles) / row.seconds;
  row.oracle_seconds = run.oracle;
  row.efficiency = row.ideal_seconds / row.seconds;
  row.cutting = run.outcome.cutting;
  row.efficiency_with_cutting = row.ideal_seconds / (row.seconds + row.cutting);
  row.times = shares_of(run.outcome);
  for (const RankOutcome& rank : run.outcome.ranks) {
    row.splits += rank.counters.splits_sent;
    row.split_messages += rank.counters.batches_sent;
    row.hand_offs += rank.counters.hand_offs;
    row.hand_off_bytes += rank.counters.hand_off_bytes;
  }
  for (const balancer::Deliberation& d : run.outcome.deliberations)
    if (d.subject == balancer::Deliberation::Subject::kPlan && d.whole) {
      ++row.whole_plans;
      if (d.verdict == balancer::Verdict::kDone) ++row.whole_plans_kept;
    }
  row.messages = run.outcome.messages();
  row.message_bytes = run.outcome.message_bytes();
  rows_.push_back(std::move(row));
}

void ExperimentTable::add_rows(const std::string& csv, std::span<const ExperimentRun> runs) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> columns = cells_of_csv(line);
  for (const ExperimentRun& run : runs) {
    if (!std::getline(lines, line) || lines.eof()) return;
    Row row = row_without_figures(run);
    const std::vector<std::string> cells = cells_of_csv(line);
    if (cells.size() != columns.size()) return;
    std::map<std::string, std::string> texts;
    for (std::size_t i = 0; i < cells.size(); ++i) texts[columns[i]] = cells[i];
    if (texts["run"] != row.run || !take_figures(row, texts)) return;
    rows_.push_back(std::move(row));
  }
}

double regret(const Row& row) {
  return row.oracle_seconds > 0 ? row.seconds / row.oracle_seconds - 1 : 0;
}

std::optional<double> recovered(const Row& row, std::span<const Row> rows) {
  if (row.policy == "none" || row.hand_offs == 0) return {};
  const auto without = std::ranges::find_if(rows, [&](const Row& other) {
    return other.policy == "none" && other.repetition == row.repetition && same_but_policy(other, row);
  });
  if (without == rows.end()) return {};
  const double saved = without->seconds - row.seconds, possible = without->seconds - without->ideal_seconds;
  if (!(possible > 0) || std::abs(saved) < without->spread + row.spread) return {};
  return saved / possible;
}

std::vector<Row> medians_of(std::span<const Row> rows) {
  std::vector<Row> medians;
  for (auto first = rows.begin(); first != rows.end();) {
    const auto end = std::find_if(first, rows.end(), [&](const Row& row) { return row.swept != first->swept; });
    std::vector<Row> repeated(first, end);
    std::ranges::sort(repeated, {}, &Row::seconds);
    Row median = repeated[repeated.size() / 2];
    median.spread = (repeated.back().seconds - repeated.front().seconds) / 2;
    median.repetition = 0;
    medians.push_back(std::move(median));
    first = end;
  }
  return medians;
}

std::string ExperimentTable::csv() const {
  std::string text;
  for (const Row& row : rows_) {
    std::vector<std::string> columns, values;
    for (const auto& [column, value] : all_cells(row, recovered(row, rows_))) {
      columns.push_back(csv_quoted(column));
      values.push_back(csv_quoted(value));
    }
    if (text.empty()) text = fmt::format("{}\n", fmt::join(columns, ","));
    text += fmt::format("{}\n", fmt::join(values, ","));
  }
  return text;
}

std::string ExperimentTable::markdown() const {
  if (rows_.empty()) return "";
  const std::vector<Row> medians = medians_of(rows_);
  const bool repeated = medians.size() < rows_.size();
  const bool saved = std::ranges::any_of(medians, [&](const Row& row) { return recovered(row, medians).has_value(); });
  const bool planned = std::ranges::any_of(medians, [](const Row& row) { return row.whole_plans > 0; });
  std::vector<Cells> rows;
  for (const Row& row : medians) {
    std::optional<std::string> share;
    if (saved) share = recovered(row, medians) ? fmt::format("{:.1f}", 100 * *recovered(row, medians)) : "";
    std::optional<std::string> kept;
    if (planned) kept = fmt::format("{} of {}", row.whole_plans_kept, row.whole_plans);
    rows.push_back(telling_cells(row, repeated, share, kept));
  }
  const Cells common = take_common(rows, medians.front().swept.size());
  std::string text = markdown_of(rows);
  std::string rest;
  for (const auto& [column, value] : common) rest += fmt::format("{}{} {}", rest.empty() ? "" : ", ", column, value);
  return rest.empty() ? text : text + "\nThe same in all: " + rest + "\n";
}

}  // namespace driftmesh::study
