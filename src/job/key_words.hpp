#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "job/key.hpp"

/// The words in which keys are declared (key_table.cpp): key("bounds.area", &R::bounds, &R::Bounds::area, "Largest area
/// of a triangle", from(0), option("area", "AREA")) is the member of a request with that name, default, range and
/// option.
namespace driftmesh::job {

using Kind = KeyInfo::Kind;
using R = Request;

inline constexpr Places kAsSection = 0;  // for a key that applies where its section does; likewise for entry points

// ---- The value of a member -------------------------------------------------------------------------------------

template <class Member>
constexpr Kind kind_of() {
  if constexpr (std::is_same_v<Member, bool>)
    return Kind::kFlag;
  else if constexpr (std::is_integral_v<Member>)
    return Kind::kInteger;
  else if constexpr (std::is_floating_point_v<Member>)
    return Kind::kNumber;
  else if constexpr (std::is_same_v<Member, std::string>)
    return Kind::kText;
  else if constexpr (std::is_same_v<Member, std::vector<double>>)
    return Kind::kNumbers;
  else if constexpr (std::is_same_v<Member, std::vector<std::string>>)
    return Kind::kOutputs;
  else
    return Kind::kTable;
}

template <class Member>
Value value_of(const Member& member) {
  if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>)
    return static_cast<std::int64_t>(member);
  else
    return member;
}

template <class Member>
Member member_of(const Value& value) {
  if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>)
    return static_cast<Member>(value.as<std::int64_t>());
  else
    return value.as<Member>();
}

// ---- Further attributes of a key --------------------------------------------------------------------------------

inline auto in(double least, double most) {
  return [=](KeyInfo& key) { key.least = least, key.most = most; };
}
inline auto from(double least) {
  return [=](KeyInfo& key) { key.least = least; };
}
inline auto above(double least) {
  return [=](KeyInfo& key) { key.least = least, key.above = true; };
}
inline auto because(const char* why_not_more) {
  return [=](KeyInfo& key) { key.why_not_more = why_not_more; };
}
inline auto unit(const char* name) {
  return [=](KeyInfo& key) { key.unit = name; };
}
inline auto file() {
  return [](KeyInfo& key) { key.kind = Kind::kFile; };
}
inline auto of_files() {
  return [](KeyInfo& key) { key.of_files = true; };
}
inline auto output_file() {
  return [](KeyInfo& key) { key.kind = Kind::kOutput; };
}
inline auto one_of(std::vector<std::string> choices) {
  return [choices = std::move(choices)](KeyInfo& key) {
    key.kind = Kind::kChoice;
    key.choices = choices;
  };
}
inline auto reserved_for(EntryPoint entry_point, const char* choice) {
  return [=](KeyInfo& key) { key.reserved[choice] = entry_point; };
}
inline auto or_file(const char* extension) {
  return [=](KeyInfo& key) { key.or_file = extension; };
}
inline auto option(const char* name, const char* value_name = "") {
  return [=](KeyInfo& key) { key.option = name, key.value_name = value_name; };
}
inline auto option(char letter, const char* name, const char* value_name) {
  return [=](KeyInfo& key) { key.letter = letter, key.option = name, key.value_name = value_name; };
}
inline auto option_help(const char* text) {
  return [=](KeyInfo& key) { key.option_help = text; };
}
inline auto places(Places where) {
  return [=](KeyInfo& key) { key.places = where; };
}
inline auto entry_points(EntryPoints which) {
  return [=](KeyInfo& key) { key.entry_points = which; };
}

/// What every declaration says; it applies where its section does unless further attributes say otherwise.
inline void describe(KeyInfo& info, const char* name, const char* help, Kind kind, Value standard) {
  info.name = name;
  info.help = help;
  info.kind = kind;
  info.standard = std::move(standard);
  info.places = kAsSection;
  info.entry_points = kAsSection;
}

template <class Owner, class Member, class... Rest>
void describe(KeyInfo& info, const char* name, Member Owner::*member, const char* help, const Rest&... rest) {
  describe(info, name, help, kind_of<Member>(), value_of(Owner{}.*member));
  (rest(info), ...);
}

/// A key whose value is a member of one of the request's sections, or of its base.
template <class Section, class Owner, class Member, class... Rest>
Key key(const char* name, Section R::*section, Member Owner::*member, const char* help, const Rest&... rest) {
  Key made;
  describe(made, name, member, help, rest...);
  made.store = [=](R& r, const Value& value) { r.*section.*member = member_of<Member>(value); };
  made.load = [=](const R& r) { return value_of(r.*section.*member); };
  return made;
}

/// A key whose value is a member of the request itself.
template <class Member, class... Rest>
Key key(const char* name, Member R::*member, const char* help, const Rest&... rest) {
  Key made;
  describe(made, name, member, help, rest...);
  made.store = [=](R& r, const Value& value) { r.*member = member_of<Member>(value); };
  made.load = [=](const R& r) { return value_of(r.*member); };
  return made;
}

template <class Enum>
using Names = std::vector<std::pair<Enum, const char*>>;

/// A key whose value is an enumerator, given by these names.
template <class Section, class Enum, class... Rest>
Key choice(const char* name, Section R::*section, Enum Section::*member, const Names<Enum>& names, const char* help,
           const Rest&... rest) {
  const auto name_of = [=](Enum value) {
    return std::string(
        std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == value; })->second);
  };
  Key made;
  describe(made, name, help, Kind::kChoice, name_of(Section{}.*member));
  for (const auto& [value, word] : names) made.choices.emplace_back(word);
  (rest(made), ...);
  made.store = [=](R& r, const Value& value) {
    r.*section.*member = std::find_if(names.begin(), names.end(), [&](const auto& n) {
                           return n.second == value.as<std::string>();
                         })->first;
  };
  made.load = [=](const R& r) { return Value(name_of(r.*section.*member)); };
  return made;
}

template <class Element, class Member>
struct Field {
  KeyInfo info;
  Member Element::*member;
};

/// A key of the records in a list.
template <class Element, class Member, class... Rest>
Field<Element, Member> field(const char* name, Member Element::*member, const char* help, const Rest&... rest) {
  Field<Element, Member> made{{}, member};
  describe(made.info, name, member, help, rest...);
  return made;
}

/// A key whose value is a list of records with these fields.
template <class Section, class Element, class... Members>
Key list(const char* name, Section R::*section, std::vector<Element> Section::*member, const char* help,
         const Field<Element, Members>&... fields) {
  Key made;
  describe(made, name, help, Kind::kList, std::vector<Record>());
  made.fields = {fields.info...};
  made.store = [=](R& r, const Value& value) {
    (r.*section.*member).clear();
    for (const Record& record : value.as<std::vector<Record>>()) {
      Element& element = (r.*section.*member).emplace_back();
      std::size_t k = 0;
      ((element.*fields.member = member_of<Members>(record[k++].second)), ...);
    }
  };
  made.load = [=](const R& r) {
    std::vector<Record> records;
    for (const Element& element : r.*section.*member)
      records.push_back({{fields.info.name, value_of(element.*fields.member)}...});
    return Value(records);
  };
  return made;
}

}  // namespace driftmesh::job
