#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/mesh_input.hpp"
#include "app/repair_view.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "job/check.hpp"
#include "job/contour.hpp"
#include "job/domain.hpp"
#include "job/files.hpp"
#include "job/input_file.hpp"
#include "job/make.hpp"
#include "picture/plot.hpp"
#include "picture/plot_sizes.hpp"

namespace driftmesh::app {
namespace {

template <class Value>
std::vector<std::string> words_of(const PlotNames<Value>& names) {
  std::vector<std::string> words;
  for (const auto& [word, value] : names) words.push_back(word);
  return words;
}

/// Stores the value with the given name.
template <class Value>
cli::Take into(Value& to, const PlotNames<Value>& names) {
  return [&](const std::string& text) {
    for (const auto& [word, value] : names)
      if (word == text) to = value;
  };
}

struct PlotCommand {
  std::string input;
  std::string output;
  PlotOptions plot;
  ReadOptions reading;
  GivenKeys sizes;
};

// "1600x900"
bool is_in_pixels(const std::string& text, int& width, int& height) {
  char rest = 0;
  return std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) == 2;
}

void read_pixels(const std::string& text, PlotOptions& plot) {
  if (!is_in_pixels(text, plot.width, plot.height))
    throw cli::UsageError("is '" + text + "'; write WIDTHxHEIGHT, such as 1600x900");
}

void read_box(const std::string& text, PlotOptions& plot) {
  std::vector<double> box;
  cli::into(box)(text);
  if (box.size() != 4 || !(box[0] < box[2] && box[1] < box[3]))
    throw cli::UsageError("is '" + text + "'; write x0,y0,x1,y1 with x0 < x1 and y0 < y1");
  plot.box = PlotBox{{box[0], box[1]}, {box[2], box[3]}};
}

std::string title_of(const std::string& input) {
  return is_standard_stream(input) ? "standard input" : std::filesystem::path(input).filename().string();
}

job::Request request_of(const PlotCommand& command) {
  job::Request request;
  command.sizes.apply(request);
  request.input.file = command.input;
  job::check(request, job::kOnePiece);
  return request;
}

void require_lengths(const std::string& expression) {
  if (int width = 0, height = 0; is_in_pixels(expression, width, height))
    throw cli::UsageError("--size is '" + expression + "', but means lengths of edges; a picture has --pixels WxH");
}

DomainShape shape_of(const job::TriangulatedDomain& made) {
  DomainShape shape;
  const Triangulation& mesh = made.triangulated.mesh;
  for (const TriangleId t : ids_of(mesh.triangles))
    if (mesh.triangles[t].alive()) shape.triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  const Pslg& pslg = made.domain.pslg;
  for (const Pslg::Segment& s : pslg.segments) shape.segments.push_back({pslg.points[s.a], pslg.points[s.b]});
  return shape;
}

void draw_sizes(const PlotCommand& command, const job::Request& request) {
  FileRegistry files;
  job::register_reads(request, job::kPlot, files);
  register_picture(files, command.output, "--output");
  RepairView view(false);
  const job::TriangulatedDomain made = job::make_triangulated({request, job::kPlot, job::Given{}}, view);
  const auto length_at = [&](const Point& p) { return made.domain.size->edge_length(p); };
  plot_sizes(shape_of(made), length_at, command.output, command.plot);
}

/// The domain that a raster describes, or the sizes in a domain.
void draw_asked(PlotCommand& command) {
  const job::Request request = request_of(command);
  const std::filesystem::path name = job::input_name(request);
  if (command.output.empty()) command.output = name.filename().replace_extension(".png").string();
  if (command.plot.title.empty()) command.plot.title = title_of(name.string());
  command.plot.name = name.string();
  require_lengths(request.sizing.expression);
  if (request.sizing.varies()) return draw_sizes(command, request);
  if (request.input.contour.empty())
    throw cli::UsageError("pictures of sizes need --size, --size-mesh, --across or --size-tree");
  FileRegistry files;
  job::register_reads(request, job::kPlot, files);
  register_picture(files, command.output, "--output");
  plot(job::contour_input(request.input).pslg, command.output, command.plot);
}

void register_files(const PlotCommand& command) {
  FileRegistry files;
  if (holds_input(command.input))
    for (const std::string& file : input_files(command.input)) files.reads(file, "INPUT");
  else
    register_mesh_input(files, command.input, "INPUT", command.reading);
  register_picture(files, command.output, "--output");
}

void run_plot(const cli::Call& call, PlotCommand& command) {
  if (call.has("pixels") && call.has("width")) throw cli::UsageError("--pixels includes the width: leave out --width");
  if (!command.sizes.items.empty()) return in_words_of_options(command.sizes, {}, [&] { draw_asked(command); });
  if (command.input.empty()) throw cli::UsageError("INPUT is missing");
  const std::filesystem::path input(command.input);
  if (command.output.empty()) command.output = input.filename().replace_extension(".png").string();
  if (command.plot.title.empty()) command.plot.title = title_of(command.input);
  command.plot.name = command.input;
  register_files(command);
  if (holds_input(command.input))
    plot(job::read_domain_file(command.input, {}).pslg, command.output, command.plot);
  else
    plot(read_any_mesh(command.input, command.reading), command.output, command.plot);
}

std::vector<cli::Option> plot_options(PlotCommand& command) {
  std::vector<cli::Option> all{
      {.kind = cli::Option::Kind::kPositional,
       .name = "input",
       .value = "INPUT",
       .help = "A mesh (" + mesh_inputs() +
               ") or an input (.poly, or a .node without .ele). - reads a .vtu from standard input, -.msh and -.poly "
               "the other formats",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.input)},
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "The picture: .png, .svg or .pdf. - writes PNG to standard output, -.svg and -.pdf the other formats",
       .standard = "the input's name with .png, in the current folder",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.output)},
      {.name = "color",
       .value = "WHAT",
       .help = "Quantity that the colors of triangles show",
       .standard = plot_colors().front().first,
       .choices = words_of(plot_colors()),
       .take = into(command.plot.color, plot_colors())},
      {.name = "edges",
       .value = "WHEN",
       .help = "Draw the edges of triangles: on, off or auto (if they are long enough to be seen)",
       .standard = plot_edges().front().first,
       .choices = words_of(plot_edges()),
       .take = into(command.plot.edges, plot_edges())},
      {.name = "width",
       .value = "PIXELS",
       .help = "Width in pixels; the height follows",
       .standard = std::to_string(command.plot.width),
       .take = cli::into(command.plot.width, {100, 20'000})},
      {.name = "pixels",
       .value = "WxH",
       .help = "Width and height in pixels, such as 1600x900",
       .take = [&plot = command.plot](const std::string& text) { read_pixels(text, plot); }},
      {.name = "box",
       .value = "X0,Y0,X1,Y1",
       .help = "Show only this part of the plane",
       .take = [&plot = command.plot](const std::string& text) { read_box(text, plot); }},
      {.name = "title",
       .value = "TEXT",
       .help = "Title of the picture",
       .standard = "the input's name",
       .take = cli::into(command.plot.title)},
      allow_outside_option(command.reading)};
  std::ranges::move(key_options(job::kPlot, command.sizes, "Draw target edge lengths (as for driftmesh mesh)"),
                    std::back_inserter(all));
  return all;
}

}  // namespace

cli::Command plot_command() {
  const auto command = std::make_shared<PlotCommand>();
  return {
      .name = "plot",
      .summary = "Draw a mesh, an input or the sizes that are asked for as PNG, SVG or PDF",
      .options = plot_options(*command),
      .notes =
          "Where triangles are smaller than about two pixels, each pixel shows the worst angle of those in it, or "
          "the mean "
          "area of those around it; auto shows areas there, and angles otherwise. With --size, colors show how long "
          "edges are to be in the domain.",
      .examples = {"driftmesh plot bay.poly -o input.svg",
                   "driftmesh plot bay.poly --size \"20+0.1*distance()\" -o sizes.png",
                   "driftmesh plot bay.vtu --color area --box 380000,4180000,420000,4210000 -o bay.svg"},
      .exit_codes = "0 done, 1 error, 2 wrong usage",
      .run = [command](cli::Call& call) {
        run_plot(call, *command);
        return 0;
      }};
}

}  // namespace driftmesh::app
