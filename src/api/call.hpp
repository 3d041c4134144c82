#pragma once

#include <functional>

#include "decompose/decomposition.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "job/domain.hpp"
#include "job/key.hpp"
#include "job/order.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "job/watch.hpp"

namespace driftmesh {

/// A size field that is a function of the caller's.
class FunctionField final : public SizeField {
 public:
  explicit FunctionField(const std::function<double(const Point&)>& function) : function_(function) {}
  /// Throws Error where the function is not positive.
  [[nodiscard]] double edge_length(const Point& p) const override;

 private:
  const std::function<double(const Point&)>& function_;
};

/// Tells the caller how the work goes on, and lets it cancel.
class CallerWatch final : public job::Watch {
 public:
  explicit CallerWatch(const std::function<bool(const Progress&)>& progress) : progress_(progress) {}
  /// Throws Cancelled if the caller does not want to go on.
  void refining(std::int64_t triangles, double forecast) override;

 private:
  const std::function<bool(const Progress&)>& progress_;
};

/// A call of the library: the caller's options as the job takes them. Input and options outlive it.
class Call {
 public:
  /// `policies`: those that can be made by name where this is called.
  Call(const Pslg& input, const MeshOptions& options, const balancer::PolicyMaker& policies = nullptr);
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  [[nodiscard]] const job::Request& request() const { return request_; }
  [[nodiscard]] const job::Given& given() const { return given_; }
  [[nodiscard]] job::Watch& watch() { return watch_; }

  /// Whether subdomains are asked for.
  [[nodiscard]] bool in_subdomains() const { return request_.decomposition.subdomains > 0 || given_.decomposition; }
  /// Throws Error for options that are out of range or mean nothing at this place.
  void check(job::Place place) const;
  /// The domain, prepared for a team. On rank 0. Throws what the job throws.
  [[nodiscard]] job::Order order_for(const job::Team& team, job::Place place);

 private:
  const MeshOptions& options_;
  job::Request request_;
  FunctionField size_;
  job::Given given_;
  CallerWatch watch_;
};

}  // namespace driftmesh
