#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace driftmesh::balancer {

/// The parameters of one policy, as a user wrote them. Reading one makes its name known; whatever was given and has not
/// been read when finish() is called is an error. All errors are InputErrors that name policy, parameter and value.
class Parameters {
 public:
  using Values = std::map<std::string, std::string>;

  Parameters(std::string policy, Values values) : policy_(std::move(policy)), values_(std::move(values)) {}

  /// A number from `least` to `most`.
  [[nodiscard]] double number(const std::string& name, double standard, double least, double most);
  [[nodiscard]] std::int64_t integer(const std::string& name, std::int64_t standard, std::int64_t least,
                                     std::int64_t most);
  [[nodiscard]] bool flag(const std::string& name, bool standard);
  /// One of `choices`, of which the first is the standard.
  [[nodiscard]] std::string choice(const std::string& name, const std::vector<std::string>& choices);
  /// All that were given of these names, whatever their values.
  [[nodiscard]] Values any_of(const std::vector<std::string>& names);

  /// Throws for the first parameter that nobody has read, and says which known one is nearest.
  void finish() const;

  /// Throws InputError for the value of a parameter: "policy P: name: value; next".
  [[noreturn]] void fail(const std::string& name, const std::string& value, const std::string& next) const;

 private:
  /// The value that was given, or null.
  const std::string* take(const std::string& name);

  std::string policy_;
  Values values_;
  std::vector<std::string> known_;
};

}  // namespace driftmesh::balancer
