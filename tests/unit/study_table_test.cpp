#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "study/experiment_table.hpp"

using namespace driftmesh;
using namespace driftmesh::study;
using Row = ExperimentTable::Row;

namespace {

Row row(const std::string& policy, double seconds, std::int32_t repetition = 0, std::int64_t moved = 3) {
  Row made;
  made.swept = {{"balance.policy", policy}};
  made.policy = policy;
  made.repetition = repetition;
  made.seconds = seconds;
  made.ideal_seconds = 4;
  made.oracle_seconds = 5;
  made.hand_offs = policy == "none" ? 0 : moved;
  return made;
}

ExperimentRun run(const std::string& policy, double seconds, std::int64_t moved) {
  ExperimentRun made;
  made.name = "run-" + policy;
  made.swept = {{"balance.policy", job::Value(policy)}};
  made.request.balance.policy = policy;
  made.outcome.makespan = seconds;
  made.outcome.owners.resize(3);
  made.outcome.ranks.resize(2);
  made.outcome.ranks[Rank{0}].counters.hand_offs = moved;
  const auto plan = [&](balancer::Verdict verdict, bool whole) {
    made.outcome.deliberations.push_back(
        {.subject = balancer::Deliberation::Subject::kPlan, .verdict = verdict, .whole = whole});
  };
  plan(balancer::Verdict::kDone, false);
  for (std::int64_t i = 0; i < moved; ++i) plan(i < 4 ? balancer::Verdict::kDone : balancer::Verdict::kOtherPlan, true);
  made.ideal = 4;
  made.oracle = 5;
  return made;
}

}  // namespace

TEST_CASE("what is recovered is a share of what could be") {
  const std::vector<Row> rows{row("none", 12), row("greedy", 6), row("zoltan", 16)};
  CHECK(recovered(rows[1], rows) == 0.75);
  CHECK(recovered(rows[2], rows) == -0.5);
  CHECK(!recovered(rows[0], rows));
  CHECK(regret(rows[1]) == doctest::Approx(0.2));
}

TEST_CASE("what noise explains is not called recovered") {
  const std::vector<Row> still{row("none", 12), row("greedy", 6, 0, 0)};
  CHECK(!recovered(still[1], still));
  std::vector<Row> rows{row("none", 12, 0),  row("none", 10, 1),   row("none", 14, 2),
                        row("greedy", 9, 0), row("greedy", 11, 1), row("greedy", 10, 2)};
  const std::vector<Row> medians = medians_of(rows);
  REQUIRE(medians.size() == 2);
  CHECK(medians[0].seconds == 12);
  CHECK(medians[0].spread == 2);
  CHECK(medians[1].seconds == 10);
  CHECK(medians[1].spread == 1);
  CHECK(!recovered(medians[1], medians));  // 2 s less, where repetitions differ by 2 and 1
  for (Row& r : rows)
    if (r.policy == "greedy") r.seconds -= 4;
  const std::vector<Row> clear = medians_of(rows);
  CHECK(recovered(clear[1], clear) == 0.75);
}

TEST_CASE("a table is read again as far as it is whole") {
  std::vector<ExperimentRun> runs{run("none", 12, 0), run("greedy", 1.0 / 3, 7), run("a \"b\", c", 1e-300, 2)};
  runs[1].repetition = 5;
  runs[2].outcome.cutting = 0.1 + 0.2;
  ExperimentTable table;
  for (const ExperimentRun& each : runs) table.add(each);
  const std::string csv = table.csv();
  std::size_t whole = 0;
  for (std::size_t end = 0; end <= csv.size(); ++end) {
    ExperimentTable again;
    again.add_rows(csv.substr(0, end), runs);
    const std::string read = again.csv();
    const auto lines = std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    REQUIRE(again.rows().size() == static_cast<std::size_t>(std::max<std::ptrdiff_t>(lines, 1) - 1));
    if (!again.rows().empty()) CHECK(csv.starts_with(read.substr(0, read.find("recovered"))));
    whole = std::max(whole, again.rows().size());
    if (whole == 3) CHECK(again.csv() == csv);
    if (whole == 3) CHECK(again.markdown() == table.markdown());
  }
  CHECK(whole == 3);
  ExperimentTable others;
  std::swap(runs[1], runs[2]);
  others.add_rows(csv, runs);
  CHECK(others.rows().size() == 1);
}

TEST_CASE("columns that are the same in all runs stand below the table") {
  ExperimentTable table;
  CHECK(table.markdown().empty());
  table.add(run("none", 12, 0));
  CHECK(table.markdown().find("The same in all") == std::string::npos);  // in one row everything is the same
  CHECK(table.markdown().find("ranks |") != std::string::npos);
  CHECK(table.markdown().find("whole plans kept") == std::string::npos);  // none were made
  table.add(run("greedy", 6, 7));
  const std::string text = table.markdown();
  const std::string rows = text.substr(0, text.find("The same in all"));
  for (const char* differs : {"balance.policy", "seconds", "recovered %", "75.0", "regret %", "20.0", "moved", "0.667",
                              "whole plans kept", "4 of 7"})
    CHECK_MESSAGE(rows.find(differs) != std::string::npos, differs);
  CHECK(rows.find("ranks") == std::string::npos);
  CHECK(text.find("ranks 2") != std::string::npos);
  const std::string csv = table.csv();
  for (const char* column :
       {"ranks", "oracle_seconds", "regret", "recovered", "repetition", "whole_plans,whole_plans_kept"})
    CHECK_MESSAGE(csv.find(column) != std::string::npos, column);
}
