#include "verify/report_text.hpp"

#include <algorithm>
#include <cmath>

#include "base/formatted.hpp"

namespace driftmesh {
namespace {

using Text = std::string&;

/// 1234567 -> "1,234,567"
std::string grouped(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i != 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

void add_interfaces(const VerifyReport& report, Text out) {
  if (report.pieces != 0) append_formatted(out, "pieces         {}\n", grouped(report.pieces));
  if (report.subdomains == 0) return;
  append_formatted(out, "subdomains     {}, {} interfaces between them of {} edges, {} of these between ranks\n",
                   grouped(report.subdomains), grouped(report.interfaces), grouped(report.interface_edges),
                   grouped(report.rank_interface_edges));
  if (report.interface_edges_not_delaunay != 0)
    append_formatted(out, "               {} of them are Delaunay only because interfaces count as constrained\n",
                     grouped(report.interface_edges_not_delaunay));
}

void add_counts(const VerifyReport& report, Text out) {
  add_interfaces(report, out);
  append_formatted(out, "points         {}", grouped(report.points));
  if (report.unused_points != 0) append_formatted(out, ", {} of them in no triangle", grouped(report.unused_points));
  append_formatted(out, "\ntriangles      {}\nsubsegments    {}, {} on the boundary\n", grouped(report.triangles),
                   grouped(report.subsegments), grouped(report.boundary_edges));
  if (!report.subsegments_listed)
    append_formatted(out, "               the file lists no subsegments; the boundary was taken as constrained\n");
  if (!report.regions_listed) append_formatted(out, "regions        not listed by the mesh and not checked\n");
  if (!report.polygons_judged)
    append_formatted(out, "polygons       cross so closely that they are checked as repaired only\n");
  append_formatted(out, "area           {:.17g}", report.area);
  if (report.against_input) append_formatted(out, ", of the input {:.17g}", report.input_area);
  append_formatted(out, "\nareas          {:.6g} to {:.6g}\nangles         {:.4f} to {:.4f} degrees\n",
                   report.quality.smallest_area, report.quality.largest_area, report.quality.smallest_angle,
                   report.quality.largest_angle);
}

void add_channels(const VerifyReport& report, const AcrossRule& rule, Text out) {
  if (rule.layers == 0) return;
  const AcrossReport& across = report.across;
  append_formatted(out, "channels       {} crossings of {}{} layers of triangles", grouped(across.crossings),
                   across.fewest < rule.layers ? "" : "at least ", across.fewest);
  if (across.fewest < rule.layers) append_formatted(out, " or more");
  if (across.too_narrow > 0)
    append_formatted(out, "; {} more are narrower than {:.6g}", grouped(across.too_narrow), rule.narrowest);
  append_formatted(out, "\n               {} triangles have all corners on the boundary\n",
                   grouped(across.on_boundary));
}

void add_histogram(const Quality& quality, Text out) {
  constexpr double kBarLength = 50;
  const auto tens = quality.angles_by_ten();
  const auto most = static_cast<double>(std::max<std::uint64_t>(1, *std::max_element(tens.begin(), tens.end())));
  for (std::size_t i = 0; i < tens.size(); ++i) {
    const auto length = static_cast<std::size_t>(std::ceil(kBarLength * static_cast<double>(tens[i]) / most));
    append_formatted(out, "  {:>3} - {:>3}  {:>13}  {}\n", 10 * i, 10 * i + 10, grouped(tens[i]),
                     std::string(length, '#'));
  }
}

void add_list(const std::vector<std::string>& messages, std::uint64_t count, Text out) {
  for (const std::string& message : messages) append_formatted(out, "    {}\n", message);
  if (count > messages.size() && !messages.empty())
    append_formatted(out, "    and {} more\n", grouped(count - messages.size()));
}

void add_exceptions(const Quality& quality, double min_angle, Text out) {
  if (quality.exception_count() == 0) return;
  append_formatted(out, "exceptions     {} triangles that miss a bound, as the input explains\n",
                   grouped(quality.exception_count()));
  for (std::size_t degree = 0; degree < 180 && static_cast<double>(degree) < min_angle; ++degree)
    if (quality.angles[degree] != 0)
      append_formatted(out, "  {:>3} - {:>3}  {:>13}\n", degree, degree + 1, grouped(quality.angles[degree]));
  for (const ExceptionReason reason : ids_of(quality.exceptions)) {
    const auto& list = quality.exceptions[reason];
    if (list.count == 0) continue;
    append_formatted(out, "  {}: {}\n", reason_name(reason), grouped(list.count));
    add_list(list.messages, list.count, out);
  }
}

void add_step(const VerifyReport& report, const VerifyOptions& options, Text out) {
  if (options.depth == nullptr || report.triangles == 0) return;
  const StepMeasures& step = report.step;
  append_formatted(out,
                   "time step      {:.4g} s holds (Courant {:g}), {:g} s asked for; Courant numbers up to {:.4g}\n",
                   options.courant.step * options.courant.bound / step.greatest, options.courant.bound,
                   options.courant.step, step.greatest);
  if (step.above == 0) return;
  append_formatted(out, "  {} triangles ({:.3g} %) do not allow it\n", grouped(step.above),
                   100 * static_cast<double>(step.above) / static_cast<double>(report.triangles));
  if (options.strict_step) return;
  for (const StepMeasures::Item& item : step.worst) append_formatted(out, "    {}\n", item.words);
  if (step.above > step.worst.size())
    append_formatted(out, "    and {} more\n", grouped(step.above - step.worst.size()));
}

void add_flaws(const Findings& findings, Text out) {
  for (const Flaw flaw : first_ids<Flaw>(kFlawCount)) {
    if (findings.count(flaw) == 0) continue;
    append_formatted(out, "{}: {}\n", flaw_name(flaw), grouped(findings.count(flaw)));
    add_list(findings.messages(flaw), findings.count(flaw), out);
  }
}

std::string what_was_checked(const VerifyReport& report, const VerifyOptions& options) {
  std::string text = report.subsegments_listed ? "constrained Delaunay" : "Delaunay inside its boundary";
  if (report.interfaces != 0) text += formatted(", conforming at {} interfaces", grouped(report.interfaces));
  if (report.against_input) text += ", covers the input";
  if (options.min_angle > 0) text += formatted(", angles of at least {} degrees", options.min_angle);
  if (const auto n = report.quality.exception_count(); n != 0)
    text += formatted(" except for {} triangles that the input explains", grouped(n));
  if (options.plain.area > 0) text += formatted(", areas of at most {}", options.plain.area);
  if (options.size != nullptr) text += ", sizes asked for";
  if (options.depth != nullptr && report.step.above == 0)
    text += formatted(", a time step of {:g} s", options.courant.step);
  if (options.across.layers > 0) text += formatted(", {} layers of triangles across channels", options.across.layers);
  return text;
}

}  // namespace

std::string report_text(const VerifyReport& report, const VerifyOptions& options) {
  std::string text;
  std::string& out = text;
  add_counts(report, out);
  add_channels(report, options.across, out);
  add_histogram(report.quality, out);
  add_exceptions(report.quality, options.min_angle, out);
  add_step(report, options, out);
  add_flaws(report.findings, out);
  return text;
}

std::string verdict_text(const VerifyReport& report, const VerifyOptions& options) {
  if (report.accepted()) return "accepted: " + what_was_checked(report, options);
  std::string text = "rejected: ";
  const char* separator = "";
  for (const Flaw flaw : first_ids<Flaw>(kFlawCount)) {
    if (report.findings.count(flaw) == 0) continue;
    text += formatted("{}{} ({})", separator, flaw_name(flaw), grouped(report.findings.count(flaw)));
    separator = ", ";
  }
  return text;
}

}  // namespace driftmesh
