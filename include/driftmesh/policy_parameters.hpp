#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace driftmesh::balancer {

/// The parameters of one policy, as given by the user. Reading one makes its name known; parameters still unread when
/// finish() is called are an error. All errors are InputErrors that name policy, parameter and value.
///
/// \code
/// driftmesh::balancer::Parameters parameters("pairs", {{"share", "0.5"}});
/// const double share = parameters.number("share", 0.25, 0, 1);
/// const bool eager = parameters.flag("eager", false);
/// parameters.finish();  // throws if a name was given that none of these calls knows
/// assert(share == 0.5 && !eager);
/// \endcode
class Parameters {
 public:
  using Values = std::map<std::string, std::string>;

  Parameters(std::string policy, Values values) : policy_(std::move(policy)), values_(std::move(values)) {}

  /// A number from `least` to `most`.
  [[nodiscard]] double number(const std::string& name, double standard, double least, double most);
  [[nodiscard]] std::int64_t integer(const std::string& name, std::int64_t standard, std::int64_t least,
                                     std::int64_t most);
  [[nodiscard]] bool flag(const std::string& name, bool standard);
  /// One of `choices`; the first is the default.
  [[nodiscard]] std::string choice(const std::string& name, const std::vector<std::string>& choices);
  /// All given parameters with these names, whatever their values.
  [[nodiscard]] Values any_of(const std::vector<std::string>& names);

  /// Throws for the first unread parameter, and suggests the nearest known one.
  void finish() const;

  /// Throws InputError for the value of a parameter: "policy P: name: value; next".
  [[noreturn]] void fail(const std::string& name, const std::string& value, const std::string& next) const;

 private:
  /// The given value, or null.
  const std::string* take(const std::string& name);

  std::string policy_;
  Values values_;
  std::vector<std::string> known_;
};

}  // namespace driftmesh::balancer
