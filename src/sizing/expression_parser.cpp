#include "sizing/expression_parser.hpp"

#include <cmath>
#include <numbers>

namespace driftmesh {

mu::Parser expression_parser() {
  mu::Parser parser;
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineConst("e", std::numbers::e);
  parser.DefineFun("hypot", static_cast<double (*)(double, double)>(std::hypot));
  return parser;
}

bool is_known_to_expressions(const std::string& name) {
  const mu::Parser parser = expression_parser();
  return name == "x" || name == "y" || parser.GetConst().contains(name) || parser.GetFunDef().contains(name);
}

}  // namespace driftmesh
