#pragma once

#include <string>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// A value that is invalid, or invalid in combination with others or at the place where it was given: the key
/// concerned, the problem ("is -5"), and what to do. The message names keys by their full names; callers that know
/// better words, such as a place in a file or an option, replace them.
class KeyError : public Error {
 public:
  KeyError(std::string key, const std::string& what, const std::string& next)
      : Error(key + " " + what + "; " + next), key_(std::move(key)), what_(what), next_(next) {}
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const std::string& problem() const { return what_; }
  [[nodiscard]] const std::string& next() const { return next_; }

 private:
  std::string key_;
  std::string what_;
  std::string next_;
};

}  // namespace driftmesh
