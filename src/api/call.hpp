#pragma once

#include <cstdint>
#include <functional>

#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "job/domain.hpp"
#include "job/key.hpp"
#include "job/make.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"

namespace driftmesh {

/// The size field of the library that a caller has passed as a function: a SizeRule, or size_on_mesh by std::ref. Null
/// if it is none.
[[nodiscard]] const SizeField* described_field(const std::function<double(const Point&)>& function);

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
  void stalled(const std::string& why) override { warned(why); }
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
  [[nodiscard]] const balancer::PolicyMaker& policies() const { return given_.policies; }
  [[nodiscard]] job::Watch& watch() { return watch_; }

  /// Where a process by itself makes the mesh: in subdomains if they are requested.
  [[nodiscard]] job::PlaceKind place() const;
  /// The number of threads for that.
  [[nodiscard]] std::int32_t threads() const;
  /// What the caller asks for at a place of this kind. Throws Error for options that contradict each other or have no
  /// meaning there; those of keys the job checks.
  [[nodiscard]] job::Asked asked(job::PlaceKind place) const { return asked(place, request_); }
  /// The same for a request, which outlives the result, that says more than the options do.
  [[nodiscard]] job::Asked asked(job::PlaceKind place, const job::Request& request) const;
  /// Throws InputError, on all ranks, if the caller is strict and triangles do not allow the time step.
  void require_step(job::Place& place, job::Refined& made, job::RunRecord& record) const;

 private:
  const MeshOptions& options_;
  job::Request request_;
  FunctionField size_;
  bool calls_back_ = false;  // whether sizes come from a function of the caller
  job::Given given_;
  CallerWatch watch_;
};

}  // namespace driftmesh
