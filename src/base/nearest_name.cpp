#include "base/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/letter_case.hpp"

namespace driftmesh {
namespace {

bool same_letter(char a, char b) {
  return lower_case(a) == lower_case(b);
}

/// The number of letters to insert, remove, replace or swap with the next one to turn one word into the other.
std::size_t edit_distance(const std::string& from, const std::string& to) {
  std::vector<std::size_t> before, last, row(to.size() + 1);  // rows of the table of all beginnings of the two words
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = last[j] + (same_letter(from[i], to[j]) ? 0 : 1);
      row[j + 1] = std::min({replaced, row[j] + 1, last[j + 1] + 1});
      if (i > 0 && j > 0 && same_letter(from[i], to[j - 1]) && same_letter(from[i - 1], to[j]))
        row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
  }
  return row.back();
}

/// Whether `word` stands in `name`, between its ends or characters that are neither letters nor digits.
bool has_word(const std::string& name, const std::string& word) {
  const auto is_part = [&](std::size_t at) {
    return at < name.size() && std::isalnum(static_cast<unsigned char>(name[at])) != 0;
  };
  const auto stands_at = [&](std::size_t at) {
    return std::equal(word.begin(), word.end(), name.begin() + static_cast<std::ptrdiff_t>(at), same_letter) &&
           !(at > 0 && is_part(at - 1)) && !is_part(at + word.size());
  };
  for (std::size_t at = 0; !word.empty() && at + word.size() <= name.size(); ++at)
    if (stands_at(at)) return true;
  return false;
}

/// As a plural does.
bool has_one_letter_more(const std::string& name, const std::string& word) {
  return name.size() == word.size() + 1 && name.starts_with(word);
}

std::vector<std::string> names_with_word(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::string> with_word;
  std::copy_if(names.begin(), names.end(), std::back_inserter(with_word),
               [&](const std::string& name) { return has_word(name, word) || has_one_letter_more(name, word); });
  return with_word;
}

std::string name_with_fewest_edits(const std::string& name, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  });
  return nearest == known.end() ? "" : *nearest;
}

}  // namespace

std::string nearest_name(const std::string& name, const std::vector<std::string>& known) {
  const std::vector<std::string> with_word = names_with_word(name, known);
  return name_with_fewest_edits(name, with_word.empty() ? known : with_word);
}

std::string probable_name(const std::string& name, const std::vector<std::string>& known) {
  const auto longer =
      std::find_if(known.begin(), known.end(), [&](const std::string& k) { return k.starts_with(name); });
  if (longer != known.end()) return *longer;
  std::string nearest = nearest_name(name, known);
  if (has_word(nearest, name)) return nearest;
  return 3 * edit_distance(name, nearest) <= nearest.size() + 1 ? nearest : "";
}

}  // namespace driftmesh
