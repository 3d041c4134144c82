#include "study/real_cluster.hpp"

#include <exception>
#include <utility>

#include "balancer/policies/policy_factory.hpp"
#include "base/bytes.hpp"
#include "job/make.hpp"
#include "job/record.hpp"
#include "job/watch.hpp"

namespace driftmesh::study {
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

job::Place& RealCluster::call(job::Method method) {
  static_cast<void>(team_.broadcast(letter_of({true, method})));
  return place_for(method);
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

}  // namespace driftmesh::study
