#include "job/domain.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/repair.hpp"
#include "job/contour.hpp"
#include "job/files.hpp"
#include "job/input_file.hpp"
#include "job/key.hpp"
#include "mesh/cdt.hpp"
#include "mesh/domain_outline.hpp"
#include "mesh/nested_rings.hpp"
#include "mesh/with_seeds.hpp"
#include "pslg/generators.hpp"
#include "pslg/names.hpp"
#include "sizing/across.hpp"
#include "sizing/described_field.hpp"
#include "sizing/sampled_field.hpp"
#include "sizing/smallest_field.hpp"

namespace driftmesh::job {
namespace {

InputFile raw_input(const Request::Input& input, const Given& given) {
  if (given.input != nullptr) return {*given.input, {}, {}};
  if (!input.contour.empty()) return contour_input(input);
  if (input.generator.empty()) return read_domain_file(input.file, input);
  return {generate(input.generator, input.parameters), {}, {}};
}

RepairOptions repairs_asked(const Request::Input& asked) {
  return {.snap = asked.snap, .hull = asked.hull};
}

/// What is left of the repaired points; `left`: their indices, -1 for new ones.
void keep_original_points(RepairReport& repairs, const std::vector<std::int32_t>& left) {
  std::vector<std::int32_t> original;
  for (const std::int32_t point : left) original.push_back(point < 0 ? point : repairs.original_point[point]);
  repairs.original_point = std::move(original);
}

/// Adds hole points to a repaired input where the rule makes holes of its rings, all of which count, whatever else is a
/// hole.
void add_nested_holes(HoleRule rule, Pslg& pslg) {
  if (rule != HoleRule::kNested) return;
  Pslg rings = with_seeds(pslg);  // keeps the regions of polygons
  rings.segments = pslg.segments;
  rings.holes.clear();
  const std::vector<Point> holes = find_nested_rings(triangulate(rings)).alternating_holes;
  pslg.holes.insert(pslg.holes.end(), holes.begin(), holes.end());
}

template <class Key, class Value>
std::vector<Key> keys_of(const std::map<Key, Value>& map) {
  std::vector<Key> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

/// Throws InputError if a request speaks of markers or regions that its input has not. `keys`: what it calls them.
template <class Value, class Asked>
void require_known(const Request& request, const std::set<Value>& known, const Asked& asked, const std::string& what,
                   const char* key) {
  const auto missing = std::ranges::find_if(asked, [&](const Value& value) { return !known.contains(value); });
  if (missing == std::end(asked)) return;
  constexpr std::size_t kMost = 20;
  std::string list;
  std::size_t listed = 0;
  for (const Value& value : known)
    if (listed++ < kMost) list += (list.empty() ? "" : ", ") + shortest_text(static_cast<double>(value));
  if (known.size() > kMost) list += " and " + std::to_string(known.size() - kMost) + " more";
  const std::string input = input_name(request);
  throw Keyed<InputError>(
      KeyText::of("{}: has no {} {}, which {} names; {}", input, what, shortest_text(static_cast<double>(*missing)),
                  KeyText::key(key), list.empty() ? "it has none" : "it has " + list),
      {input});
}

void check_markers_and_regions(const Request& request, const Pslg& pslg) {
  std::set<std::int32_t> markers;
  for (const Pslg::Segment& segment : pslg.segments) markers.insert(segment.marker);
  if (pslg.segments.empty()) markers.insert(0);  // the hull of the points
  const std::vector<double>& open = request.output.open_boundary;
  require_known(request, markers, std::vector<std::int32_t>(open.begin(), open.end()), "segment with marker",
                "output.open-boundary");
  std::set<double> regions;
  for (const Pslg::Region& region : pslg.regions) regions.insert(region.attribute);
  if (!regions.empty()) regions.insert(0);  // the rest of the domain
  const Names names = names_of(request.input);
  require_known(request, markers, keys_of(names.markers), "segment with marker", "input.marker-names");
  require_known(request, regions, keys_of(names.regions), "region", "input.region-names");
}

/// Names that the request gives replace those that the input has.
void name_markers_and_regions(const Request& request, Pslg& pslg) {
  Names names = names_of(request.input);
  names.markers.merge(pslg.names.markers);
  names.regions.merge(pslg.names.regions);
  check_names(names, input_name(request));
  pslg.names = std::move(names);
}

void open_rasters(const Request& request, Domain& domain, Watch& watch) {
  domain.rasters = rasters_of(request, domain.projection, domain.from_lonlat);
  if (domain.rasters.files.empty()) return;
  if (!request.output.depth.empty() && domain.pslg.attributes_per_point > 0)
    throw Keyed<InputError>({input_name(request)}, "has attributes of points, but depths would take their place",
                            "remove {output.depth} or the attributes");
  const auto opened = [&] { return open_all(domain.rasters, box_of(domain.pslg), domain.pslg.points); };
  warn(request, timed(watch, "rasters", opened), watch);
}

}  // namespace

Names names_of(const Request::Input& asked) {
  Names names;
  for (const auto& [number, name] : asked.marker_names) {
    const auto marker = marker_from(number);
    if (!marker) throw KeyError("input.marker-names", "has '" + number + "' as a marker", "markers are whole numbers");
    if (!names.markers.emplace(*marker, name).second)
      throw KeyError("input.marker-names", "names marker " + number + " twice", "remove one of them");
  }
  for (const auto& [number, name] : asked.region_names) {
    const auto region = region_from(number);
    if (!region) throw KeyError("input.region-names", "has '" + number + "' as a region", "regions are numbers");
    if (!names.regions.emplace(*region, name).second)
      throw KeyError("input.region-names", "names region " + number + " twice", "remove one of them");
  }
  return names;
}

Domain read_domain(const Request& request, const Given& given, Watch& watch) {
  Domain domain;
  InputFile input = timed(watch, "read", [&] { return raw_input(request.input, given); });
  domain.pslg = std::move(input.pslg);
  domain.projection = std::move(input.projection);
  domain.from_lonlat = input.from_lonlat;
  check_markers_and_regions(request, domain.pslg);
  name_markers_and_regions(request, domain.pslg);
  warn(request, input.warnings, watch);
  domain.repairs =
      timed(watch, "repair", [&] { return repair(domain.pslg, input_name(request), repairs_asked(request.input)); });
  const std::vector<std::string> warnings = std::exchange(domain.repairs.warnings, {});
  watch.repaired(domain.repairs);
  warn(request, warnings, watch);
  if (request.input.simplify > 0) {
    domain.simplified =
        timed(watch, "simplify", [&] { return simplify(domain.pslg, request.input.simplify, input_name(request)); });
    keep_original_points(domain.repairs, std::exchange(domain.simplified.original_point, {}));
  }
  add_nested_holes(request.input.holes, domain.pslg);
  if (const double width = request.input.close_channels; width > 0) {
    domain.closed =
        timed(watch, "close channels", [&] { return close_channels(domain.pslg, width, input_name(request)); });
    keep_original_points(domain.repairs, std::exchange(domain.closed.original_point, {}));
  }
  open_rasters(request, domain, watch);
  SizeSource source =
      timed(watch, "size", [&] { return size_of(request.sizing, domain.rasters.open, given.size, domain.pslg); });
  domain.size = std::move(source.field);
  domain.background = source.background;
  domain.rules = given.rules;
  domain.step = step_of(request.sizing, domain.rasters);
  const Request::Sizing& sizes = request.sizing;
  if (sizes.across > 0 && sizes.shortest > 0)
    domain.creeks = timed(watch, "creeks", [&] {
      return find_creeks(domain_outline(domain.pslg), width_for(sizes.shortest, sizes.across));
    });
  return domain;
}

RepairReport clean_input(const Request::Input& asked, const std::string& name, Pslg& pslg) {
  RepairReport repairs = repair(pslg, name, repairs_asked(asked));
  if (asked.simplify > 0) simplify(pslg, asked.simplify, name);
  if (asked.close_channels > 0) {
    add_nested_holes(asked.holes, pslg);
    close_channels(pslg, asked.close_channels, name);
  }
  return repairs;
}

HoleRule holes_left(const Request::Input& asked) {
  return asked.close_channels > 0 ? HoleRule::kPoints : asked.holes;
}

void warn(const Request& request, std::span<const std::string> warnings, Watch& watch) {
  constexpr std::size_t kMost = 10;
  if (warnings.empty()) return;
  const auto more = [&](std::size_t listed) {
    return std::to_string(warnings.size() - listed) + " more such warnings";
  };
  if (request.input.strict)
    throw InputError({input_name(request), 0}, warnings[0] + (warnings.size() > 1 ? ", and " + more(1) : ""),
                     "correct the input, or accept its warnings (not strict)");
  const std::size_t listed = warnings.size() <= kMost + 1 ? warnings.size() : kMost;
  for (const std::string& warning : warnings.first(listed)) watch.warn(warning);
  if (listed < warnings.size()) watch.warn(more(listed));
}

namespace {

/// What a caller describes, for the domain of other options.
SizingOptions in_domain(SizingOptions asked, const SizingOptions& other) {
  asked.spacing = other.spacing;
  asked.domain = other.domain;
  asked.input = other.input;
  asked.outline = other.outline;
  asked.across = other.across;
  return asked;
}

}  // namespace

SizeSource size_of(const Request::Sizing& sizing, const NamedRasters& rasters, const SizeField* given,
                   const Pslg& pslg) {
  SizingOptions options = sizing_of(sizing, pslg);
  options.rasters = rasters;
  if (given == nullptr) return make_size(options);
  if (const auto* described = dynamic_cast<const DescribedField*>(given))
    return make_size(in_domain(described->asked(), options));
  auto sampled = std::make_unique<SampledField>(*given, SampledField::Grid{options.domain.low, options.spacing});
  SizeSource source = make_size(options);
  if (source.field == nullptr) return {std::move(sampled), nullptr};
  std::vector<std::unique_ptr<SizeField>> both;
  both.push_back(std::move(sampled));
  both.push_back(std::move(source.field));
  return {std::make_unique<SmallestField>(std::move(both)), std::move(source.background)};
}

SizeSource exact_size_of(const SizeField& described, const Pslg* input, const Box& box) {
  const Request::Sizing plain;
  SizingOptions asked = in_domain(dynamic_cast<const DescribedField&>(described).asked(),
                                  input != nullptr ? sizing_of(plain, *input) : sizing_of(plain, box));
  asked.exact = true;
  return make_size(asked);
}

CourantRule courant_of(const Request::Sizing& sizing) {
  return {sizing.courant_step, sizing.courant, sizing.courant_speed, sizing.courant_length};
}

std::shared_ptr<const TimeStep> step_of(const Request::Sizing& sizing, const Rasters& rasters) {
  if (sizing.courant_step == 0) return nullptr;
  return std::make_shared<const TimeStep>(courant_of(sizing), rasters.depths());
}

Box box_of(const Pslg& pslg) {
  if (pslg.segments.empty()) return Box::of(pslg.points);
  Box box;
  for (const Pslg::Segment& s : pslg.segments)
    for (const std::int32_t end : {s.a, s.b}) box.extend(pslg.points[end]);
  return box;
}

SizingOptions sizing_of(const Request::Sizing& asked, const Box& box) {
  SizingOptions sizing;
  sizing.domain = box;
  sizing.spacing = std::max(box.high.x - box.low.x, box.high.y - box.low.y) / static_cast<double>(asked.resolution);
  sizing.expression = asked.expression;
  sizing.background = asked.background;
  sizing.tree = asked.tree;
  sizing.across = asked.across;
  if (asked.gradation > 0) sizing.gradation = asked.gradation;
  sizing.shortest = asked.shortest;
  if (asked.longest > 0) sizing.longest = asked.longest;
  return sizing;
}

SizingOptions sizing_of(const Request::Sizing& asked, const Pslg& pslg) {
  SizingOptions sizing = sizing_of(asked, box_of(pslg));
  sizing.input = &pslg;
  sizing.outline = [&pslg] { return domain_outline(pslg); };
  return sizing;
}

std::string input_name(const Request& request) {
  const Request::Input& input = request.input;
  if (!input.file.empty()) return input.file;
  if (!input.contour.empty()) return contour_files(input);
  if (input.generator.empty()) return "input";
  std::string name = input.generator;
  for (const auto& [parameter, value] : input.parameters) name += " --" + parameter + " " + value;
  return name;
}

}  // namespace driftmesh::job
