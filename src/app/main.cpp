#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "app/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"driftmesh: quality Delaunay meshes of planar domains"};
  app.require_subcommand(1);
  driftmesh::app::add_check(app);
  driftmesh::app::add_convert(app);
  driftmesh::app::add_generate(app);
  driftmesh::app::add_plot(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << "driftmesh: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
