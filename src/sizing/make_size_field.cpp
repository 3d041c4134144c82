#include "sizing/make_size_field.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "pslg/triangle_files.hpp"
#include "sizing/background_field.hpp"
#include "sizing/combined_field.hpp"
#include "sizing/exact_field.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/gradation.hpp"
#include "sizing/grown_function.hpp"
#include "sizing/sampled_field.hpp"
#include "sizing/size_tree.hpp"

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

BackgroundMesh background_mesh(const NodeTable& nodes, EleTable elements, const std::string& file) {
  try {
    return {nodes.points, std::move(elements.triangles)};
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
                       "the target edge length at point " + std::to_string(i + nodes.first_number) + " is " +
                           std::to_string(lengths[i]),
                       "make the first attribute of every point a positive length");
  }
  return lengths;
}

template <class Field>
SizeSource source_of(std::unique_ptr<Field> field) {
  const BackgroundMesh& mesh = field->mesh();
  return {std::move(field), &mesh};
}

SizeSource graded_field(BackgroundMesh mesh, std::vector<double> lengths, std::optional<double> gradation) {
  if (gradation) limit_gradation(mesh.points(), mesh.triangles(), *gradation, lengths);
  return source_of(std::make_unique<VertexSizeField>(std::move(mesh), std::move(lengths)));
}

SizeSource area_field(BackgroundMesh mesh, const std::vector<double>& areas, std::optional<double> gradation) {
  if (!gradation) return source_of(std::make_unique<TriangleAreaField>(std::move(mesh), areas));
  std::vector<double> lengths(areas.size());
  std::transform(areas.begin(), areas.end(), lengths.begin(), edge_length_of_area);
  std::vector<double> at_points = shortest_at_points(mesh, lengths);
  return graded_field(std::move(mesh), std::move(at_points), gradation);
}

std::unique_ptr<SizeField> expression_field(const SizingOptions& options) {
  constexpr double kNarrow = 0.5, kLittle = 0.1;
  constexpr GrownFunction::Accuracy kExact{.narrow = 0.2, .search = 0.97};
  const auto field = std::make_shared<const ExpressionField>(options.expression, options.shortest, options.longest,
                                                             options.input, options.rasters, options.outline);
  std::shared_ptr<const PlaneFunction> function = field->function();
  if (options.gradation)
    function = std::make_shared<const GrownFunction>(
        field, function, *options.gradation, options.domain,

        options.exact ? kExact : GrownFunction::Accuracy{std::min(kNarrow, kLittle / *options.gradation)},
        options.spacing);
  if (options.exact) return std::make_unique<ExactField>(field, function, options.domain);
  return std::make_unique<SizeTree>(field, function, options.domain, options.spacing, SizeTree::Rules{});
}

/// A background mesh tells all about what lies in it, but not what the nearest points of its boundary say outside.
std::unique_ptr<SizeField> sampled_outside(SizeSource source, const SizingOptions& options) {
  const BackgroundMesh& mesh = *source.background;
  if (mesh.covers(options.domain) || !std::isfinite(options.spacing)) return std::move(source.field);
  const auto inside = [&mesh](const std::array<Point, 3>& triangle) { return mesh.covers(triangle); };
  return std::make_unique<SampledField>(std::move(source.field),
                                        SampledField::Grid{options.domain.low, options.spacing}, inside);
}

void require_sound(const SizingOptions& options) {
  if (!(options.longest > 0))
    throw InputError({"longest edge length"}, std::to_string(options.longest), "it must be positive");
  if (!(options.shortest >= 0) || options.shortest > options.longest)
    throw InputError({"shortest edge length"}, std::to_string(options.shortest),
                     "it must lie between 0 and the longest edge length");
}

}  // namespace

SizeSource read_background_field(const std::string& path, std::optional<double> gradation) {
  if (gradation && !(*gradation > 0 && std::isfinite(*gradation)))
    throw InputError({"gradation"}, std::to_string(*gradation), "it must be positive; 0.2 to 0.3 grade well");
  if (is_standard_stream(path))
    throw InputError({path}, "a background mesh consists of two or three files, but standard input is only one",
                     "name its .node");
  const std::string stem = stem_of(path);
  const NodeTable nodes = read_node(stem + ".node");
  EleTable elements = read_ele(stem + ".ele", nodes);
  const std::size_t triangle_count = elements.triangles.size();
  BackgroundMesh mesh = background_mesh(nodes, std::move(elements), stem + ".ele");
  if (has_ending(path, ".area"))
    return area_field(std::move(mesh), read_area(stem + ".area", triangle_count), gradation);
  return graded_field(std::move(mesh), lengths_at_points(nodes, stem + ".node"), gradation);
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
  SizeSource made;
  std::vector<std::unique_ptr<SizeField>> fields;
  if (!options.expression.empty()) fields.push_back(expression_field(options));
  if (!options.background.empty()) {
    SizeSource source = read_background_field(options.background, options.gradation);
    made.background = source.background;
    fields.push_back(sampled_outside(std::move(source), options));
  }
  const bool is_bounded = options.background.empty() && !fields.empty();  // what the expression is by itself
  if (std::isfinite(options.longest) && !is_bounded) fields.push_back(std::make_unique<UniformField>(options.longest));
  if (fields.size() == 1 && (options.shortest == 0 || is_bounded))
    made.field = std::move(fields.front());
  else if (!fields.empty())
    made.field = std::make_unique<SmallestField>(std::move(fields), options.shortest);
  return made;
}

std::unique_ptr<SizeField> make_size_field(const SizingOptions& options) {
  return make_size(options).field;
}

}  // namespace driftmesh
