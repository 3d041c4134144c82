#include "study/timeline.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "driftmesh/error.hpp"
#include "study/chrome_trace.hpp"

namespace driftmesh::study {
namespace {

using config::Json;

constexpr double kBreak = 1.0 / 2000;  // fraction of the run: shorter breaks cannot be seen

/// An event of a trace, as far as it matters here.
struct Event {
  std::string phase, name, verdict;
  std::int32_t rank = 0;
  double start = 0, duration = 0;  // microseconds
  std::int64_t triangles = 0;
  double to_be_made = 0;
  std::int64_t moves = 0;  // only those made
};

struct Slice {
  std::int32_t rank;
  double start, stop;
  std::int64_t triangles;
  double to_be_made;
};

/// Reads event by event: the values of a whole trace would take ten times the memory of its text.
class TraceReader final : public nlohmann::json_sax<Json> {
 public:
  std::vector<Slice> slices;
  std::vector<Timeline::Plan> plans;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    if (depth_ == kInEvent && key_ == "ph") event_.phase = value;
    if (depth_ == kInEvent && key_ == "name") event_.name = value;
    if (depth_ == kInArguments && key_ == "verdict") event_.verdict = value;
    if (depth_ == kInMove && key_ == "verdict" && value == "done") ++event_.moves;
    return true;
  }
  bool key(string_t& value) override {
    key_ = value;
    return true;
  }
  bool start_array(std::size_t) override { return ++depth_, true; }
  bool end_array() override { return --depth_, true; }
  bool start_object(std::size_t) override {
    if (++depth_ == kInEvent) event_ = {};
    return true;
  }
  bool end_object() override {
    if (depth_-- == kInEvent) take();
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  // {"traceEvents": [{"args": {"moves": [{}]}}]}
  static constexpr int kInEvent = 3, kInArguments = 4, kInMove = 6;

  bool number(double value) {
    if (depth_ == kInEvent && key_ == "tid") event_.rank = static_cast<std::int32_t>(value);
    if (depth_ == kInEvent && key_ == "ts") event_.start = value;
    if (depth_ == kInEvent && key_ == "dur") event_.duration = value;
    if (depth_ == kInArguments && key_ == "triangles") event_.triangles = static_cast<std::int64_t>(value);
    if (depth_ == kInArguments && key_ == "to_be_made") event_.to_be_made = value;
    return true;
  }

  void take() {
    const Event& e = event_;
    if (e.phase == "X" && e.name == "refine")
      slices.push_back({e.rank, e.start / kMicro, (e.start + e.duration) / kMicro, e.triangles, e.to_be_made});
    // A look that finds the load even is no plan, and neither is one without moves.
    const bool plans_something = e.name.starts_with("plan:") || e.name.starts_with("advice:");
    if (e.phase == "i" && plans_something && e.name != "plan: no moves")
      plans.push_back({e.rank, e.start / kMicro, e.name, e.verdict == "done", e.moves});
  }

  int depth_ = 0;
  std::string key_;
  Event event_;
};

std::vector<Timeline::Busy> joined(const std::vector<Slice>& slices, double end) {
  std::vector<Timeline::Busy> busy;
  for (const Slice& s : slices) {
    if (!busy.empty() && busy.back().rank == s.rank && s.start - busy.back().stop < kBreak * end) {
      busy.back().stop = s.stop;
      busy.back().triangles = s.triangles;
    } else {
      busy.push_back({s.rank, s.start, s.stop, s.triangles});
    }
  }
  return busy;
}

/// At some times what the last slice of each rank has left; before its first one, what that has.
std::vector<Timeline::Load> load_over_time(const std::vector<Slice>& slices, double end) {
  std::vector<std::size_t> at, last;  // indices of slices: for each rank, the latest so far; for each, its last
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (i == 0 || slices[i].rank != slices[i - 1].rank) at.push_back(i), last.push_back(i);
    last.back() = i;
  }
  std::vector<Timeline::Load> load;
  for (int k = 0; k <= kLoadSamples && !at.empty(); ++k) {
    const double time = end * k / kLoadSamples;
    std::vector<double> left;
    for (std::size_t r = 0; r < at.size(); ++r) {
      while (at[r] < last[r] && slices[at[r] + 1].stop <= time) ++at[r];
      left.push_back(slices[at[r]].to_be_made);
    }
    const auto [least, most] = std::ranges::minmax(left);
    load.push_back(
        {time, least, std::accumulate(left.begin(), left.end(), 0.0) / static_cast<double>(left.size()), most});
  }
  return load;
}

}  // namespace

Timeline timeline_of(const std::string& text, const std::filesystem::path& path) {
  TraceReader reader;
  if (!Json::sax_parse(text, &reader))
    throw InputError({path.string(), 0}, "is not JSON", "remove it, or make the run again");
  std::ranges::sort(reader.slices, {}, [](const Slice& s) { return std::tuple(s.rank, s.start); });
  double end = 0;
  for (const Slice& s : reader.slices) end = std::max(end, s.stop);
  return {joined(reader.slices, end), std::move(reader.plans), load_over_time(reader.slices, end)};
}

Json json_of(const Timeline& timeline) {
  Json busy = Json::array(), plans = Json::array(), load = Json::array();
  for (const Timeline::Busy& b : timeline.busy) busy.push_back({b.rank, b.start, b.stop, b.triangles});
  for (const Timeline::Plan& p : timeline.plans)
    plans.push_back({{"rank", p.rank},
                     {"time", p.time},
                     {"what", p.what},
                     {"plan", p.made ? "made" : "rejected"},
                     {"moves", p.moves}});
  for (const Timeline::Load& l : timeline.load)
    load.push_back({{"time", l.time}, {"least", l.least}, {"mean", l.mean}, {"most", l.most}});
  return {{"busy", std::move(busy)}, {"plans", std::move(plans)}, {"load", std::move(load)}};
}

}  // namespace driftmesh::study
