// A rank that joins the work late: when it creates its loop, the others have been refining for a while, have sent it
// points, asked it for work or handed some over. All these messages wait for it; the mesh is correct, and the rank does
// its part.
#include <doctest/doctest.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "driftmesh/generate.hpp"
#include "job/mpi/mpi_team.hpp"
#include "job/order.hpp"
#include "mpi/mesh_on_ranks.hpp"
#include "protocol/mpi/mpi_transport.hpp"
#include "support/late_plan.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

using namespace driftmesh;
using namespace driftmesh::protocol;
using driftmesh::testing::LateCase;
using driftmesh::testing::LateStart;

namespace {

constexpr double kTriangles = 15'000;
constexpr int kHeadStart = 30;  // slices by which the others are ahead; without it, each would do 130 and more
constexpr auto kRest =
    std::chrono::microseconds(1500);  // pause of the others after each slice, so that enough work is left

/// Makes the late rank wait until another one has its head start, which that one reports by calling `reached`.
class StartingGun {
 public:
  explicit StartingGun(Rank late) : transport_(MpiSession::world()), late_(late) {}

  void wait() {
    while (!transport_.poll()) std::this_thread::sleep_for(kRest);
  }
  void reached(int slices) {
    if (slices == kHeadStart && transport_.rank() == next_in_ring(late_, transport_.ranks()))
      transport_.send(late_, {});
  }
  void fire() { transport_.send(late_, {}); }
  void close() { transport_.close(); }

 private:
  MpiTransport transport_;
  Rank late_;
};

/// Keeps what is said of ranks that do not answer, and fires at the first line.
class Waiting final : public job::Watch {
 public:
  explicit Waiting(StartingGun& gun) : gun_(gun) {}
  void stalled(const std::string& why) override {
    if (lines.empty()) gun_.fire();
    lines.push_back(why);
  }
  std::vector<std::string> lines;

 private:
  StartingGun& gun_;
};

/// What one rank did.
struct LoopReport {
  int slices = 0;
  ProtocolCounters counters;

  [[nodiscard]] Bytes pack() const {
    ByteWriter writer;
    writer.value(slices);
    writer.value(counters);
    return writer.take();
  }
  static LoopReport unpack(const Bytes& bytes) {
    ByteReader reader(bytes);
    LoopReport report;
    reader.value(report.slices);
    reader.value(report.counters);
    return report;
  }
};

void check_mesh(const Mesh& mesh, const Pslg& input, const QualityBounds& bounds) {
  const VerifyOptions options{.min_angle = bounds.min_angle, .plain = {.area = bounds.plain.area}};
  const VerifyReport report = verify(mesh, input, options);
  CHECK_MESSAGE(report.accepted(), report_text(report, options));
  CHECK(mesh.triangles.size() > kTriangles / 2);
}

bool gives(const LateCase& late) {
  return late.policy != "none";
}

void check_reports(const LateCase& late, const std::vector<Bytes>& reports) {
  std::int64_t sent = 0, handled = 0;
  for (const Bytes& bytes : reports) {
    const LoopReport report = LoopReport::unpack(bytes);
    sent += report.counters.splits_sent;
    handled += report.counters.splits_handled;
  }
  CHECK(sent == handled);
  const LoopReport latecomer = LoopReport::unpack(reports[to_index(late.rank)]);
  CHECK((latecomer.slices > 0) == (late.start != LateStart::kNothing || gives(late)));
  if (late.start == LateStart::kShare) CHECK(latecomer.counters.splits_handled > 0);
  if (late.start != LateStart::kShare) CHECK((latecomer.counters.arrivals > 0) == gives(late));
}

void run_with(const LateCase& late) {
  CAPTURE(late.policy);
  CAPTURE(late.rank);
  job::MpiTeam team(MpiSession::world());
  StartingGun gun(late.rank);
  job::Order order;
  order.pslg = generate_holes({.columns = 3, .rows = 2});
  order.plan = testing::late_plan(order.pslg, kTriangles, team.ranks(), late);
  const Pslg input = order.pslg;
  const bool is_late = team.rank() == late.rank;

  LoopReport report;
  job::Watch watch;
  job::RankRun run(team, std::move(order), {}, nullptr, watch);
  run.refine(false, {.through = [&](Transport& inner) -> Transport& {
                       if (is_late) gun.wait();
                       return inner;
                     },
                     .before_step = {},
                     .after_slice =
                         [&](const RankLoop::Slice&) {
                           ++report.slices;
                           if (is_late) return;
                           gun.reached(report.slices);
                           std::this_thread::sleep_for(kRest);
                         }});
  report.counters = run.loop().protocol().counters();
  const std::vector<Bytes> reports = team.gather(report.pack());
  const Mesh mesh = mpi_test::gathered(team, run);
  gun.close();
  if (team.leads()) {
    check_reports(late, reports);
    check_mesh(mesh, input, run.plan().bounds);
  }
  team.close();
}

Rank last_rank() {
  MpiTransport transport(MpiSession::world());
  const Rank last{transport.ranks() - 1};
  transport.close();
  return last;
}

}  // namespace

TEST_CASE("a rank that joins late with nothing is given work") {
  for (const char* policy : {"none", "zoltan", "diffusion", "stealing", "greedy"}) run_with({policy, last_rank()});
}

TEST_CASE("the rank that plans for all, and begins to look for the end, may join late") {
  for (const char* policy : {"none", "zoltan", "greedy"}) run_with({policy, Rank{0}});
}

TEST_CASE("a rank that joins late with one subdomain is given more") {
  for (const char* policy : {"zoltan", "diffusion"}) run_with({policy, last_rank(), LateStart::kOneSubdomain});
}

TEST_CASE("a rank that joins late with subdomains receives the messages to them") {
  for (const char* policy : {"none", "zoltan", "diffusion", "stealing", "greedy"})
    run_with({policy, last_rank(), LateStart::kShare});
}

TEST_CASE("a rank that stops in the middle of its work is named by the next one, and the mesh is whole all the same") {
  job::MpiTeam team(MpiSession::world());
  const Rank sleeper{team.ranks() - 1};
  StartingGun gun(sleeper);
  job::Order order;
  order.pslg = generate_holes({.columns = 3, .rows = 2});
  order.plan = testing::late_plan(order.pslg, kTriangles, team.ranks(), {"none", sleeper, LateStart::kShare});
  order.patience.silence = 0.6;
  const Pslg input = order.pslg;
  bool has_slept = false;
  Waiting watch(gun);
  job::RankRun run(team, std::move(order), {}, nullptr, watch);
  run.refine(false, {.through = {}, .before_step = {}, .after_slice = [&](const RankLoop::Slice&) {
                       if (team.rank() == sleeper && !std::exchange(has_slept, true)) gun.wait();
                     }});
  const Mesh mesh = mpi_test::gathered(team, run);
  gun.close();
  if (team.leads()) {  // which comes after the last
    REQUIRE(!watch.lines.empty());
    CHECK(watch.lines[0].starts_with("rank " + to_string(sleeper) + " on " + team.host() + " has not answered for "));
    check_mesh(mesh, input, run.plan().bounds);
  }
  team.close();
}
