#include "api/library_request.hpp"

#include <cctype>

#include "job/keys.hpp"

namespace driftmesh {
namespace {

/// Replaces `word` wherever it stands by itself.
void replace_word(std::string& text, const std::string& word, const std::string& by) {
  const auto is_part = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '-');
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    if (is_part(at + word.size()) || (at > 0 && is_part(at - 1))) {
      at += word.size();
      continue;
    }
    text.replace(at, word.size(), by);
    at += by.size();
  }
}

}  // namespace

job::Request request_of(const MeshOptions& options) {
  job::Request request;
  const std::int64_t no_limit = request.limits.max_triangles;
  visit_options(options, request, [](const char*, const char*, const auto& value, auto& place) { place = value; });
  if (options.max_triangles == 0) request.limits.max_triangles = no_limit;
  return request;
}

std::string in_words_of_options(const std::string& message) {
  std::string text = message;
  job::Request unused;
  visit_options(MeshOptions{}, unused, [&](const char* key, const char* member, const auto&, const auto&) {
    const std::string own = std::string("MeshOptions::") + member;
    replace_word(text, key, own);
    const std::string option = job::find_key(key).key->option;
    if (!option.empty()) replace_word(text, "--" + option, own);
  });
  replace_word(text, "sizing.size", "MeshOptions::size");  // a function, which no key can hold
  return text;
}

}  // namespace driftmesh
