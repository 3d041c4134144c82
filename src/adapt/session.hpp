#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapt/demand.hpp"
#include "adapt/divide.hpp"
#include "adapt/fields.hpp"
#include "adapt/fit_lengths.hpp"
#include "adapt/generation.hpp"
#include "adapt/join.hpp"
#include "adapt/loads.hpp"
#include "adapt/move.hpp"
#include "adapt/regenerate.hpp"
#include "adapt/saved.hpp"
#include "base/bytes.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/pslg.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::adapt {

/// The mesh that a session begins with: plan and input are the same on all ranks, parts those of this one.
struct Start {
  RunPlan plan;  ///< without a size field
  Pslg pslg;     ///< repaired
  std::map<SubdomainId, SubdomainMesh> parts;
  std::map<SubdomainId, Lengths> lengths;  ///< by which they were made, at their vertices; empty: none were asked for
};

/// What a call of a session is made with.
struct Means {
  Ranks& ranks;
  std::int32_t threads = 1;  ///< of this process
  Placing place{};           ///< after a generation is made; empty: parts stay where they are
};

/// A mesh that is refined and coarsened from one generation to the next, on one or many ranks, the same bit for bit.
/// See AdaptiveMesh. What takes Means is collective, and throws on all ranks what one of them throws.
class Session {
 public:
  /// `finish`: adds to each new piece what only the caller knows.
  Session(Start start, const AdaptiveOptions& options, std::function<void(Mesh&)> finish, const Means& means);
  /// Goes on with a session that was saved, as the one that saved it would have.
  Session(Saved saved, std::function<void(Mesh&)> finish, const Means& means);

  [[nodiscard]] const Generation& present() const { return present_; }
  [[nodiscard]] const DistributedPiece& piece() const { return present_.piece; }
  [[nodiscard]] const Pslg& pslg() const { return pslg_; }
  [[nodiscard]] const Decomposition& decomposition() const { return plan_.decomposition; }
  /// For each subdomain those before the last call of adapt() of which it is what they were, or a part of it,
  /// ascending.
  [[nodiscard]] std::vector<std::vector<std::int32_t>> parents() const;
  [[nodiscard]] const AdaptiveOptions& options() const { return options_; }
  [[nodiscard]] const AdaptReport& report() const { return report_; }
  [[nodiscard]] const std::vector<std::int32_t>& stayed_points() const { return stayed_.points; }
  [[nodiscard]] const std::vector<std::int32_t>& stayed_triangles() const { return stayed_.triangles; }

  /// Makes the next generation. If anything throws, everything stays as it is.
  void adapt(std::span<const double> lengths, const Means& means, const Hooks& hooks);
  void adapt(const SizeField& size, const Means& means, const Hooks& hooks);
  [[nodiscard]] std::vector<double> lengths_from_error(std::span<const double> indicators, double target, double order,
                                                       const Means& means) const;

  void attach(const std::string& name, std::vector<double> values, FieldPlace place, Transfer how, const Means& means,
              std::vector<std::int64_t> shape = {});
  void detach(const std::string& name, const Means& means);
  [[nodiscard]] std::span<double> field(const std::string& name);
  [[nodiscard]] const Fields& fields() const { return fields_; }
  /// Of the values of a field at each place; see Shapes.
  [[nodiscard]] std::vector<std::int64_t> shape(const std::string& name);

  /// Whether the piece before each call of adapt() is kept, from the next one on. Not collective.
  void keep_old(bool keep);
  /// The piece before the last call. Throws Error if it was not kept.
  [[nodiscard]] const DistributedPiece& old_piece() const;

  /// See adapt::save. `more`: what only the caller knows.
  void save(const std::string& path, Bytes more, const Means& means);

  /// Notes how long the caller has worked on the present mesh, by which parts are placed once the next one is made. Not
  /// collective; numbers that do not suit are an Error then.
  void spent(double seconds) { spent_ = {.on_rank = seconds}; }
  void spent(std::span<const double> seconds) { spent_ = {.on_parts = std::vector(seconds.begin(), seconds.end())}; }

  /// Throws Error, on all ranks, unless they all make this call of the same session at the same generation.
  void require_same_call(const std::string& call, Ranks& ranks) const;

 private:
  /// The parts of a generation that are not put together yet.
  struct Unfinished {
    Held from;
    Parts parts;
    const Decomposition& decomposition;  ///< with what is cut further as a whole
    std::optional<CutFurther> cut;
    Descendants descendants;
  };
  void advance(const std::function<Wanted()>& want, const Means& means, const Hooks& hooks);
  [[nodiscard]] Holding finished(Unfinished& next, const Means& means, AdaptReport& report) const;
  [[nodiscard]] IdVector<SubdomainId, Demand> demands_of(const Wanted& wanted, std::int32_t threads,
                                                         Ranks& ranks) const;
  [[nodiscard]] IdVector<SubdomainId, Fate> fates_of(const Basis& basis, const std::vector<SubdomainId>& joined,
                                                     Ranks& ranks) const;
  [[nodiscard]] Generation assembled(const Decomposition& decomposition, Parts parts, Ranks& ranks) const;
  [[nodiscard]] Holding placed(Holding made, const Decomposition& decomposition, const Descendants& descendants,
                               const Means& means, AdaptReport& report) const;
  void set_decomposition(Decomposition decomposition, const IdVector<SubdomainId, SubdomainId>& whole_of);
  [[nodiscard]] Field& find_field(const std::string& name);

  RunPlan plan_;
  std::int32_t shares_ = 0;  // subdomains at the beginning
  Descendants descendants_;
  Pslg pslg_;
  AdaptiveOptions options_;
  std::function<void(Mesh&)> finish_;
  std::int64_t number_ = 0;  // distinguishes the sessions of a process; that of rank 0
  Generation present_;
  AdaptReport report_;
  Stayed stayed_;
  Fields fields_;
  Shapes shapes_;
  Spent spent_;  // on the present mesh
  bool keeps_old_ = false;
  std::optional<DistributedPiece> old_;
};

}  // namespace driftmesh::adapt
