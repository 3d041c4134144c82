#pragma once

#include <exception>
#include <string>
#include <utility>

#include "base/key_text.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

/// The part of an error that knows its message in parts. what() calls keys by their full names until an entry point
/// throws the error in its own words; the parts stay with it.
class NamesKeys {
 public:
  virtual ~NamesKeys() = default;
  [[nodiscard]] const KeyText& text() const { return text_; }
  /// Throws the same error with what() in these words.
  [[noreturn]] virtual void throw_in(const Words& words) const = 0;

 protected:
  explicit NamesKeys(KeyText text) : text_(std::move(text)) {}
  NamesKeys(const NamesKeys&) = default;
  NamesKeys& operator=(const NamesKeys&) = default;

 private:
  KeyText text_;
};

/// An error of this kind whose message names keys.
template <class Kind>
class Keyed : public Kind, public NamesKeys {
 public:
  explicit Keyed(const KeyText& text, const Words& words = full_name) : Kind(text.in(words)), NamesKeys(text) {}
  [[noreturn]] void throw_in(const Words& words) const override { throw Keyed(text(), words); }
};

/// An InputError keeps the place that it is about.
template <>
class Keyed<InputError> : public InputError, public NamesKeys {
 public:
  explicit Keyed(const KeyText& text, const SourcePlace& place = {}, const Words& words = full_name)
      : InputError(text.in(words), place), NamesKeys(text) {}
  /// The rest of the message is that of an InputError.
  Keyed(const SourcePlace& place, const std::string& what, const KeyText& next)
      : Keyed(KeyText::of("{}; {}", InputError(place, what, "").what(), next), place) {}
  [[noreturn]] void throw_in(const Words& words) const override { throw Keyed(text(), place(), words); }
};

/// A value that is invalid, or invalid in combination with others or at the place where it was given: the key
/// concerned, the problem ("is -5"), and what to do.
class KeyError : public Error, public NamesKeys {
 public:
  KeyError(const std::string& key, const KeyText& problem, const KeyText& next)
      : KeyError(key, problem, next, full_name) {}
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const KeyText& problem() const { return problem_; }
  [[nodiscard]] const KeyText& next() const { return next_; }
  [[noreturn]] void throw_in(const Words& words) const override { throw KeyError(key_, problem_, next_, words); }

 private:
  KeyError(const std::string& key, const KeyText& problem, const KeyText& next, const Words& words)
      : KeyError(key, problem, next, KeyText::of("{} {}; {}", KeyText::key(key), problem, next), words) {}
  KeyError(std::string key, KeyText problem, KeyText next, const KeyText& text, const Words& words)
      : Error(text.in(words)),
        NamesKeys(text),
        key_(std::move(key)),
        problem_(std::move(problem)),
        next_(std::move(next)) {}

  std::string key_;
  KeyText problem_, next_;
};

/// The message of an exception, in parts if it has any.
[[nodiscard]] inline KeyText text_of(const std::exception& error) {
  const auto* const parts = dynamic_cast<const NamesKeys*>(&error);
  return parts != nullptr ? parts->text() : KeyText(std::string(error.what()));
}

}  // namespace driftmesh
