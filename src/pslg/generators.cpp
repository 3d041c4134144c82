#include "pslg/generators.hpp"

#include <algorithm>
#include <sstream>
#include <type_traits>

#include "base/from_chars.hpp"
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
    const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      throw InputError(of + " is '" + text + "'; give " + (std::is_integral_v<Value> ? "a whole number" : "a number"));
  }
}

template <class Options>
Options options_from(const std::string& name, const Parameters& parameters) {
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
  return options;
}

template <class Options, Pslg (*make)(const Options&)>
Pslg generate_with(const std::string& name, const Parameters& parameters) {
  return make(options_from<Options>(name, parameters));
}

template <class Options>
void require_with(const std::string& name, const Parameters& parameters) {
  require_valid(options_from<Options>(name, parameters));
}

template <class Options>
std::vector<GeneratorParameter> parameters_of() {
  Options options;
  std::vector<GeneratorParameter> parameters;
  visit_parameters(options, [&](const char* name, const auto& value, const char* help) {
    std::ostringstream standard;
    standard << std::boolalpha << value;
    parameters.push_back({name, standard.str(), help});
  });
  return parameters;
}

struct Generator {
  const char* name;
  Pslg (*make)(const std::string&, const Parameters&);
  void (*require)(const std::string&, const Parameters&);
  std::vector<GeneratorParameter> (*parameters)();
};

template <class Options, Pslg (*make)(const Options&)>
constexpr Generator generator(const char* name) {
  return {name, generate_with<Options, make>, require_with<Options>, parameters_of<Options>};
}

constexpr Generator kGenerators[] = {generator<PipeOptions, generate_pipe>("pipe"),
                                     generator<CylinderFlowOptions, generate_cylinder_flow>("cylinder-flow"),
                                     generator<BayOptions, generate_bay>("bay"),
                                     generator<FanOptions, generate_fan>("fan"),
                                     generator<CombOptions, generate_comb>("comb"),
                                     generator<HolesOptions, generate_holes>("holes"),
                                     generator<RectangleHoleOptions, generate_rectangle_hole>("rectangle-hole"),
                                     generator<RandomPolygonOptions, generate_random_polygon>("random-polygon"),
                                     generator<RandomPointsOptions, generate_random_points>("random-points")};

const Generator& find_generator(const std::string& name) {
  for (const Generator& generator : kGenerators)
    if (name == generator.name) return generator;
  throw InputError("no input '" + name + "' can be generated; the nearest one is '" +
                   nearest_name(name, generator_names()) + "'");
}

}  // namespace

std::vector<std::string> generator_names() {
  std::vector<std::string> names;
  for (const Generator& generator : kGenerators) names.emplace_back(generator.name);
  return names;
}

std::vector<GeneratorParameter> generator_parameters(const std::string& name) {
  return find_generator(name).parameters();
}

void require_generated(const std::string& name, const std::map<std::string, std::string>& parameters) {
  find_generator(name).require(name, parameters);
}

Pslg generate(const std::string& name, const std::map<std::string, std::string>& parameters) {
  return find_generator(name).make(name, parameters);
}

}  // namespace driftmesh
