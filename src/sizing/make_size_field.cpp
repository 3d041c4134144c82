#include "sizing/make_size_field.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "pslg/triangle_files.hpp"
#include "sizing/across.hpp"
#include "sizing/exact_field.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/gradation.hpp"
#include "sizing/grown_function.hpp"
#include "sizing/limited_function.hpp"
#include "sizing/size_tree.hpp"
#include "sizing/size_tree_file.hpp"
#include "sizing/uniform_field.hpp"

namespace driftmesh {
namespace {

bool has_ending(const std::string& path, std::string_view ending) {
  return path.size() > ending.size() && path.ends_with(ending);
}

std::string stem_of(const std::string& path) {
  for (const std::string_view ending : {".node", ".ele", ".area"})
    if (has_ending(path, ending)) return path.substr(0, path.size() - ending.size());
  return path;
}

using Mesh = std::shared_ptr<const BackgroundMesh>;
using Background = std::shared_ptr<const BackgroundFunction>;

Mesh background_mesh(const NodeTable& nodes, EleTable elements, const std::string& file) {
  try {
    return std::make_shared<const BackgroundMesh>(nodes.points, std::move(elements.triangles));
  } catch (const Error& error) {
    throw InputError({file}, error.what(), "give a mesh of triangles");
  }
}

/// The first attribute of each point.
std::vector<double> lengths_at_points(const NodeTable& nodes, const std::string& file) {
  const std::size_t stride = nodes.attributes_per_point;
  if (stride == 0)
    throw InputError({file}, "its points have no attribute to take as the target edge length",
                     "add one, or give the .area file with the area bounds of the triangles");
  std::vector<double> lengths(nodes.points.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = nodes.attributes[i * stride];
    if (!(lengths[i] > 0))
      throw InputError({file},
                       formatted("the target edge length at point {} is {}", i + nodes.first_number, lengths[i]),
                       "make the first attribute of every point a positive length");
  }
  return lengths;
}

Background of_areas(Mesh mesh, const std::vector<double>& areas, std::optional<double> gradation) {
  if (!gradation) return BackgroundFunction::of_areas(std::move(mesh), areas);
  std::vector<double> lengths(areas.size());
  std::transform(areas.begin(), areas.end(), lengths.begin(), edge_length_of_area);
  std::vector<double> at_points = shortest_at_points(*mesh, lengths);
  limit_gradation(mesh->points(), mesh->triangles(), *gradation, at_points);
  return BackgroundFunction::of_points(std::move(mesh), std::move(at_points));
}

Background of_points(Mesh mesh, std::vector<double> lengths, std::optional<double> gradation) {
  if (gradation) limit_gradation(mesh->points(), mesh->triangles(), *gradation, lengths);
  return BackgroundFunction::of_points(std::move(mesh), std::move(lengths));
}

/// The expression that is asked for, and what layers across channels ask for.
std::string lengths_of(const SizingOptions& options) {
  if (options.across == 0) return options.expression;
  const std::string across = "width()/" + std::to_string(width_for(1, options.across));
  return options.expression.empty() ? across : "min(" + options.expression + ", " + across + ")";
}

/// With limited growth, if that is asked for. `field`: gives the lengths of the expression.
std::shared_ptr<const PlaneFunction> grown(std::shared_ptr<const ExpressionField> field, const SizingOptions& options) {
  constexpr double kNarrow = 0.5, kLittle = 0.1;
  constexpr GrownFunction::Accuracy kExact{.narrow = 0.2, .search = 0.97};
  std::shared_ptr<const PlaneFunction> function = field->function();
  if (!options.gradation) return function;
  const GrownFunction::Accuracy compiled{std::min(kNarrow, kLittle / *options.gradation)};
  return std::make_shared<const GrownFunction>(std::move(field), std::move(function), *options.gradation,
                                               options.domain, options.exact ? kExact : compiled, options.spacing);
}

void require_sound(const SizingOptions& options) {
  if (!(options.longest > 0))
    throw InputError({"longest edge length"}, formatted("{}", options.longest), "it must be positive");
  if (!(options.shortest >= 0) || options.shortest > options.longest)
    throw InputError({"shortest edge length"}, formatted("{}", options.shortest),
                     "it must lie between 0 and the longest edge length");
}

}  // namespace

Background read_background(const std::string& path, std::optional<double> gradation) {
  if (gradation && !(*gradation > 0 && std::isfinite(*gradation)))
    throw InputError({"gradation"}, formatted("{}", *gradation), "it must be positive; 0.2 to 0.3 grade well");
  if (is_standard_stream(path))
    throw InputError({path}, "a background mesh consists of two or three files, but standard input is only one",
                     "name its .node");
  const std::string stem = stem_of(path);
  const NodeTable nodes = read_node(stem + ".node");
  EleTable elements = read_ele(stem + ".ele", nodes);
  const std::size_t triangle_count = elements.triangles.size();
  Mesh mesh = background_mesh(nodes, std::move(elements), stem + ".ele");
  if (has_ending(path, ".area")) return of_areas(std::move(mesh), read_area(stem + ".area", triangle_count), gradation);
  return of_points(std::move(mesh), lengths_at_points(nodes, stem + ".node"), gradation);
}

std::vector<std::string> background_files(const std::string& path) {
  if (is_standard_stream(path)) return {path};  // is refused when it is read
  const std::string stem = stem_of(path);
  std::vector<std::string> files{stem + ".node", stem + ".ele"};
  if (has_ending(path, ".area")) files.push_back(path);
  return files;
}

SizeSource make_size(const SizingOptions& options) {
  require_sound(options);
  if (!options.tree.empty()) return {read_size_tree(options.tree, domain_digest(*options.input)), nullptr};
  const double shortest = options.shortest > 0 ? options.shortest : intervals::kAll.low;
  std::vector<std::shared_ptr<const PlaneFunction>> functions;
  std::shared_ptr<const ExpressionField> expression;
  if (!options.expression.empty() || options.across > 0) {
    expression = std::make_shared<const ExpressionField>(lengths_of(options), options.shortest, options.longest,
                                                         options.input, options.rasters, options.outline);
    functions.push_back(grown(expression, options));
  }
  Background background = options.lengths;
  if (!options.background.empty()) background = read_background(options.background, options.gradation);
  if (background != nullptr) {
    const bool is_limited = options.shortest > 0 || std::isfinite(options.longest);
    functions.push_back(is_limited ? limited(background, shortest, options.longest) : background);
  }
  if (functions.empty()) {
    if (!std::isfinite(options.longest)) return {};
    return {std::make_unique<UniformField>(options.longest), nullptr};
  }
  SizeSource made;
  if (background != nullptr) made.background = background->mesh();
  std::shared_ptr<const PlaneFunction> function = least_of(std::move(functions));
  if (options.exact)
    made.field = std::make_unique<ExactField>(expression, std::move(function), background, options.domain);
  else
    made.field =
        std::make_unique<SizeTree>(expression, std::move(function), options.domain, options.spacing, SizeTree::Rules{});
  return made;
}

std::unique_ptr<SizeField> make_size_field(const SizingOptions& options) {
  return make_size(options).field;
}

}  // namespace driftmesh
