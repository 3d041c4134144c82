#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "io/mesh_file.hpp"
#include "picture/plot.hpp"
#include "pslg/poly_file.hpp"

namespace driftmesh::app {
namespace {

const std::map<std::string, PlotColor> kColors = {{"angle", PlotColor::angle},   {"area", PlotColor::area},
                                                  {"region", PlotColor::region}, {"subdomain", PlotColor::subdomain},
                                                  {"rank", PlotColor::rank},     {"none", PlotColor::none}};
const std::map<std::string, PlotEdges> kEdges = {
    {"auto", PlotEdges::automatic}, {"on", PlotEdges::on}, {"off", PlotEdges::off}};

template <class Value>
std::vector<std::string> keys_of(const std::map<std::string, Value>& names) {
  std::vector<std::string> keys;
  for (const auto& entry : names) keys.push_back(entry.first);
  return keys;
}

struct PlotCommand {
  std::string input;
  std::string output;
  PlotOptions plot;
  std::string color = "angle";
  std::string edges = "auto";
  std::string size;
  std::vector<double> box;
};

// "1600x900"
std::string check_size(const std::string& text) {
  int width = 0;
  int height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) == 2) return {};
  return "'" + text + "' is not WIDTHxHEIGHT, for example 1600x900";
}

std::string check_box(const std::vector<double>& box) {
  if (box.empty() || (box.size() == 4 && box[0] < box[2] && box[1] < box[3])) return {};
  return "--box needs x0,y0,x1,y1 with x0 < x1 and y0 < y1";
}

// A .node file without an .ele beside it is points alone.
bool holds_input(const std::filesystem::path& path) {
  if (path.extension() != ".node") return path.extension() == ".poly";
  return !std::filesystem::exists(std::filesystem::path(path).replace_extension(".ele"));
}

void check_color(const PlotCommand& command, const MeshPiece& mesh) {
  const bool tells = (command.plot.color != PlotColor::subdomain || !mesh.subdomains.empty()) &&
                     (command.plot.color != PlotColor::rank || !mesh.ranks.empty());
  if (!tells)
    throw InputError({command.input, 0}, "does not tell the " + command.color + " of its triangles",
                     "only .pvtu, .vtu and .msh files of distributed meshes do; choose another --color");
}

void run_plot(PlotCommand& command) {
  if (const std::string problem = check_box(command.box); !problem.empty()) throw CLI::ValidationError(problem);
  command.plot.color = kColors.at(command.color);
  command.plot.edges = kEdges.at(command.edges);
  if (!command.box.empty()) command.plot.box = Box{{command.box[0], command.box[1]}, {command.box[2], command.box[3]}};
  if (!command.size.empty())
    (void)std::sscanf(command.size.c_str(), "%dx%d", &command.plot.width, &command.plot.height);
  const std::filesystem::path input(command.input);
  if (command.output.empty()) command.output = input.filename().replace_extension(".png").string();
  if (command.plot.title.empty()) command.plot.title = input.filename().string();
  if (holds_input(input)) return plot_pslg(read_poly(command.input), command.output, command.plot);
  const MeshPiece mesh = read_mesh(command.input);
  check_color(command, mesh);
  plot_mesh(mesh, command.output, command.plot);
}

}  // namespace

void add_plot(CLI::App& program) {
  const auto options = std::make_shared<PlotCommand>();
  CLI::App* command = program.add_subcommand("plot", "Draw a mesh or an input as PNG, SVG or PDF");
  command
      ->add_option("input", options->input,
                   "A mesh (.vtu, .pvtu, .msh, .ele, .node) or an input (.poly, or a .node without .ele)")
      ->type_name("")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "The picture: .png, .svg or .pdf  [the input's name with .png, in this folder]")
      ->type_name("FILE");
  command->add_option("--color", options->color, "What the triangles' colours show")
      ->check(CLI::IsMember(keys_of(kColors)))
      ->type_name("WHAT")
      ->capture_default_str();
  command->add_option("--edges", options->edges, "Draw the triangles' edges; auto: where they can be seen")
      ->check(CLI::IsMember(keys_of(kEdges)))
      ->type_name("WHEN")
      ->capture_default_str();
  CLI::Option* const width = command->add_option("--width", options->plot.width, "Width in pixels; the height follows")
                                 ->type_name("PIXELS")
                                 ->capture_default_str();
  command->add_option("--size", options->size, "Width and height in pixels, as 1600x900")
      ->check(check_size)
      ->type_name("WxH")
      ->excludes(width);
  command->add_option("--box", options->box, "Show only this part of the plane")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X0,Y0,X1,Y1");
  command->add_option("--title", options->plot.title, "The title  [the input's name]")->type_name("TEXT");
  command->footer(
      "Where triangles are smaller than about two pixels, each pixel shows the worst angle, or the mean\n"
      "area, of the triangles in it.\n"
      "Examples:\n"
      "  driftmesh plot bay.poly -o input.svg\n"
      "  driftmesh plot bay.vtu --color area --box 380000,4180000,420000,4210000 -o bay.svg\n"
      "Exit code: 0 done, 1 error, 2 wrong usage.");
  command->callback([options] { run_plot(*options); });
}

}  // namespace driftmesh::app
