#include "app/real_cluster.hpp"

#include <exception>
#include <utility>

#include "balancer/policies/policy_factory.hpp"
#include "base/bytes.hpp"

namespace driftmesh::app {
namespace {

/// What rank 0 says before each run: there is one more, by this method, or none.
struct Call {
  bool another = false;
  job::Method method = job::Method::kCoupled;
};

Bytes letter_of(const Call& call) {
  ByteWriter writer;
  writer.value(call.another);
  writer.value(call.method);
  return writer.take();
}

Call call_in(const Bytes& bytes) {
  ByteReader reader(bytes);
  Call call;
  reader.value(call.another);
  reader.value(call.method);
  return call;
}

}  // namespace

RealCluster::RealCluster()
    : team_(protocol::MpiSession::world()), subdomains_(team_, balancer::make_policy, true), lattice_(team_) {}

RealCluster::~RealCluster() {
  if (leads()) static_cast<void>(team_.broadcast(letter_of({})));
}

job::Place& RealCluster::place_for(job::Method method) {
  if (method == job::Method::kPdr) return lattice_;
  return subdomains_;
}

std::unique_ptr<job::Refined> RealCluster::make(const job::Asked& asked, job::RunRecord& record, job::Watch& watch) {
  const job::Method method = asked.request.run.method;
  static_cast<void>(team_.broadcast(letter_of({true, method})));
  std::unique_ptr<job::Refined> made = job::make(asked, place_for(method), record, watch);
  made->report(record);
  return made;
}

void RealCluster::serve() {
  job::Watch watch;
  while (true) {
    const Call call = call_in(team_.broadcast({}));
    if (!call.another) return;
    try {
      job::RunRecord unused;
      job::follow(place_for(call.method), watch)->report(unused);
    } catch (const std::exception&) {  // all ranks have it, and rank 0 decides what is next
    }
  }
}

}  // namespace driftmesh::app
