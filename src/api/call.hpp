#pragma once

#include <cstdint>
#include <functional>

#include "decompose/decomposition.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "job/domain.hpp"
#include "job/key.hpp"
#include "job/limits.hpp"
#include "job/order.hpp"
#include "job/request.hpp"
#include "job/triangulated.hpp"
#include "job/watch.hpp"

namespace driftmesh {

/// A size field from a function of the caller.
class FunctionField final : public SizeField {
 public:
  explicit FunctionField(const std::function<double(const Point&)>& function) : function_(function) {}
  /// Throws Error where the function is not positive.
  [[nodiscard]] double edge_length(const Point& p) const override;

 private:
  const std::function<double(const Point&)>& function_;
};

/// Reports warnings and progress to the caller, and lets it cancel.
class CallerWatch final : public job::Watch {
 public:
  /// Calls MeshOptions::warning and MeshOptions::progress where they are set.
  explicit CallerWatch(const MeshOptions& options) : options_(options) {}
  void warned(const std::string& warning) override;
  /// Throws Cancelled if the caller cancels.
  void refining(std::int64_t triangles, double forecast) override;

 private:
  const MeshOptions& options_;
};

/// A call of the library: the caller's options in the form of the job. Input and options must outlive it.
class Call {
 public:
  /// `policies`: makes those available by name to this caller.
  Call(const Pslg& input, const MeshOptions& options, const balancer::PolicyMaker& policies = nullptr);
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  [[nodiscard]] const job::Request& request() const { return request_; }
  [[nodiscard]] const job::Given& given() const { return given_; }
  [[nodiscard]] job::Watch& watch() { return watch_; }

  /// Where a process by itself makes the mesh: in subdomains if they are requested.
  [[nodiscard]] job::Place place() const;
  /// The number of threads for that.
  [[nodiscard]] std::int32_t threads() const;
  /// Throws Error for options that are out of range or have no meaning at this place.
  void check(job::Place place) const { check(place, request_); }
  /// The same for a request that says more than the options do.
  void check(job::Place place, const job::Request& request) const;
  /// Throws what reading the input throws.
  [[nodiscard]] job::Domain read_domain() { return job::read_domain(request_, given_, watch_); }
  /// The domain, triangulated to be cut, prepared for this number of ranks. Throws like the job.
  [[nodiscard]] job::Order order(job::Domain domain, const job::Triangulated& triangulated, job::Place place,
                                 std::int32_t ranks, const job::Processes& processes = {});

 private:
  const MeshOptions& options_;
  job::Request request_;
  FunctionField size_;
  job::Given given_;
  CallerWatch watch_;
};

}  // namespace driftmesh
