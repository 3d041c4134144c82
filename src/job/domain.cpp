#include "job/domain.hpp"

#include "driftmesh/repair.hpp"
#include "pslg/generators.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::job {
namespace {

Pslg raw_input(const Request::Input& input, const Given& given) {
  if (given.input != nullptr) return *given.input;
  return input.generator.empty() ? read_poly(input.file) : generate(input.generator, input.parameters);
}

}  // namespace

Domain read_domain(const Request& request, const Given& given, Watch& watch) {
  Domain domain;
  domain.pslg = timed(watch, "read", [&] { return raw_input(request.input, given); });
  domain.repairs = timed(watch, "repair", [&] { return repair(domain.pslg, input_name(request)); });
  watch.repaired(domain.repairs);
  domain.own_size = timed(watch, "size", [&] { return make_size_field(sizing_of(request.sizing)); });
  domain.size = given.size != nullptr ? given.size : domain.own_size.get();
  return domain;
}

SizingOptions sizing_of(const Request::Sizing& asked) {
  SizingOptions sizing;
  sizing.expression = asked.expression;
  sizing.background = asked.background;
  if (asked.gradation > 0) sizing.gradation = asked.gradation;
  sizing.shortest = asked.shortest;
  if (asked.longest > 0) sizing.longest = asked.longest;
  return sizing;
}

std::string input_name(const Request& request) {
  const Request::Input& input = request.input;
  if (!input.file.empty()) return input.file;
  if (input.generator.empty()) return "input";
  std::string name = input.generator;
  for (const auto& [parameter, value] : input.parameters) name += " --" + parameter + " " + value;
  return name;
}

}  // namespace driftmesh::job
