#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "adapt/session.hpp"
#include "api/call.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/options.hpp"
#include "job/limits.hpp"
#include "job/place.hpp"
#include "job/rasters.hpp"

namespace driftmesh {

/// What adaptive meshes of one process and of many ranks have in common: a session, with what the caller's options say
/// of all its generations.
class AdaptiveCore {
 public:
  /// `threads`: of this process; not those that ask a size of the caller.
  AdaptiveCore(const MeshOptions& options, std::int32_t threads)
      : options_(options), watch_(options_), threads_(threads) {}
  AdaptiveCore(const AdaptiveCore&) = delete;
  AdaptiveCore& operator=(const AdaptiveCore&) = delete;

  /// Makes the first generation at the place, to be called once. `finish`: as of adapt::Session, after point data.
  void begin(Call& call, job::Place& place, const AdaptiveOptions& adaptive, Ranks& ranks,
             const std::function<void(Mesh&)>& finish);

  /// Goes on with a saved session instead. `processes`: those of the ranks.
  void resume(const std::string& path, const job::Processes& processes, Ranks& ranks,
              const std::function<void(Mesh&)>& finish);
  void save(const std::string& path, Ranks& ranks);

  [[nodiscard]] adapt::Session& session() { return *session_; }
  [[nodiscard]] const adapt::Session& session() const { return *session_; }
  [[nodiscard]] std::map<std::string, FieldPlace> fields() const;
  [[nodiscard]] const MeshOptions& options() const { return options_; }
  [[nodiscard]] std::int32_t threads() const { return threads_; }
  [[nodiscard]] adapt::Means means(Ranks& ranks) const { return {ranks, threads_, {}}; }

  /// Throws Error if a function of the caller asks for this while another one is at work.
  void require_rest() const;
  void adapt(std::span<const double> lengths, Ranks& ranks, const adapt::Placing& place = {});
  void adapt(const std::function<double(const Point&)>& size, Ranks& ranks, const adapt::Placing& place = {});

 private:
  template <class Work>
  void advance(const Work& work);
  [[nodiscard]] std::function<void(Mesh&)> finishing(const std::function<void(Mesh&)>& finish) const;

  MeshOptions options_;
  CallerWatch watch_;
  std::int32_t threads_;
  job::Limits limits_;
  job::Rasters rasters_;
  std::optional<adapt::Session> session_;
  bool busy_ = false;
};

}  // namespace driftmesh
