#include "pslg/generators.hpp"

#include <algorithm>
#include <charconv>
#include <type_traits>

#include "base/nearest_name.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

using Parameters = std::map<std::string, std::string>;

template <class Value>
void read_value(const std::string& text, const std::string& of, Value& value) {
  if constexpr (std::is_same_v<Value, bool>) {
    if (text != "true" && text != "false") throw InputError(of + " is '" + text + "'; it is either true or false");
    value = text == "true";
  } else {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      throw InputError(of + " is '" + text + "'; give " + (std::is_integral_v<Value> ? "a whole number" : "a number"));
  }
}

template <class Options, Pslg (*make)(const Options&)>
Pslg generate_with(const std::string& name, const Parameters& parameters) {
  Options options;
  std::vector<std::string> known;
  std::size_t used = 0;
  visit_parameters(options, [&](const char* parameter, auto& value, const char*) {
    known.emplace_back(parameter);
    const auto given = parameters.find(parameter);
    if (given == parameters.end()) return;
    ++used;
    read_value(given->second, "parameter '" + given->first + "' of " + name, value);
  });
  if (used < parameters.size())
    for (const auto& [parameter, value] : parameters)
      if (std::find(known.begin(), known.end(), parameter) == known.end())
        throw InputError(name + " has no parameter '" + parameter + "'; the nearest one is '" +
                         nearest_name(parameter, known) + "'");
  return make(options);
}

struct Generator {
  const char* name;
  Pslg (*make)(const std::string&, const Parameters&);
};

constexpr Generator kGenerators[] = {{"pipe", generate_with<PipeOptions, generate_pipe>},
                                     {"cylinder-flow", generate_with<CylinderFlowOptions, generate_cylinder_flow>},
                                     {"bay", generate_with<BayOptions, generate_bay>},
                                     {"fan", generate_with<FanOptions, generate_fan>},
                                     {"comb", generate_with<CombOptions, generate_comb>},
                                     {"holes", generate_with<HolesOptions, generate_holes>},
                                     {"rectangle-hole", generate_with<RectangleHoleOptions, generate_rectangle_hole>},
                                     {"random-polygon", generate_with<RandomPolygonOptions, generate_random_polygon>},
                                     {"random-points", generate_with<RandomPointsOptions, generate_random_points>}};

}  // namespace

std::vector<std::string> generator_names() {
  std::vector<std::string> names;
  for (const Generator& generator : kGenerators) names.emplace_back(generator.name);
  return names;
}

Pslg generate(const std::string& name, const std::map<std::string, std::string>& parameters) {
  for (const Generator& generator : kGenerators)
    if (name == generator.name) return generator.make(name, parameters);
  throw InputError("no input '" + name + "' can be generated; the nearest one is '" +
                   nearest_name(name, generator_names()) + "'");
}

}  // namespace driftmesh
