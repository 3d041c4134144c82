#include "base/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace driftmesh {
namespace {

bool same_letter(char a, char b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return lower(a) == lower(b);
}

/// The number of letters to insert, remove or replace to get from one word to the other.
std::size_t edit_distance(const std::string& from, const std::string& to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : from) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = diagonal + (same_letter(letter, to[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(const std::string& name, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  });
  return nearest == known.end() ? "" : *nearest;
}

std::string probable_name(const std::string& name, const std::vector<std::string>& known) {
  const auto longer =
      std::find_if(known.begin(), known.end(), [&](const std::string& k) { return k.starts_with(name); });
  if (longer != known.end()) return *longer;
  const std::string nearest = nearest_name(name, known);
  return 2 * edit_distance(name, nearest) <= nearest.size() ? nearest : "";
}

}  // namespace driftmesh
