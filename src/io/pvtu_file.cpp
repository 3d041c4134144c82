#include <filesystem>

#include "base/file_identity.hpp"
#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "io/pvtu_format.hpp"
#include "io/xml_scanner.hpp"
#include "mesh/merge_pieces.hpp"

namespace driftmesh {
namespace {

namespace fs = std::filesystem;

/// A file name with the characters that are special in XML escaped.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string unescaped(std::string text) {
  for (const auto& [code, character] :
       {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}})
    for (std::size_t found = 0; (found = text.find(code, found)) != std::string::npos; ++found)
      text.replace(found, std::string_view(code).size(), character);
  return text;
}

class PvtuFile {
 public:
  explicit PvtuFile(const std::string& path) : sink_(path) {}

  void write(const std::string& path, std::int32_t pieces, const VtuArrays& arrays) {
    sink_.text(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <PUnstructuredGrid GhostLevel=\"0\">\n");
    sink_.text(arrays.numbers ? "    <PPointData GlobalIds=\"global_number\">\n" : "    <PPointData>\n");
    for_each_point_array(
        arrays, [&]<class T>(const T*, const char* name, std::int32_t components) { declare<T>(name, components); });
    sink_.text("    </PPointData>\n    <PCellData>\n");
    for_each_cell_array(arrays, [&]<class T>(const T*, const char* name) { declare<T>(name, 1); });
    sink_.text("    </PCellData>\n    <PPoints>\n");
    declare<double>("Points", 3);
    sink_.text("    </PPoints>\n");
    for (std::int32_t k = 0; k < pieces; ++k)
      sink_.text("    <Piece Source=\"" + escaped(fs::path(pvtu_piece_path(path, k)).filename().string()) + "\"/>\n");
    sink_.text("  </PUnstructuredGrid>\n</VTKFile>\n");
    sink_.commit();
  }

 private:
  template <class T>
  void declare(const char* name, std::int32_t components) {
    sink_.text(std::string("      <PDataArray type=\"") + vtk_type_name<T>() + "\" Name=\"" + name + '"');
    if (components != 1) sink_.text(" NumberOfComponents=\"" + std::to_string(components) + '"');
    sink_.text("/>\n");
  }

  FileSink sink_;
};

}  // namespace

std::string pvtu_piece_path(const std::string& path, std::int32_t k) {
  return fs::path(path).replace_extension().string() + '_' + std::to_string(k) + ".vtu";
}

void write_pvtu(const std::string& path, std::int32_t pieces, const VtuArrays& arrays) {
  PvtuFile(path).write(path, pieces, arrays);
}

std::vector<std::string> parse_pvtu(const std::string& file, std::string_view bytes, const ReadOptions& options) {
  XmlScanner scanner(file, bytes);
  XmlTag tag;
  std::vector<std::string> pieces;
  bool is_pvtu = false, is_complete = false;
  while (scanner.next(tag)) {
    if (tag.name == "VTKFile" && tag.opens) is_pvtu = tag.attribute("type") == "PUnstructuredGrid";
    if (tag.name == "VTKFile" && !tag.opens) is_complete = true;
    if (tag.name != "Piece") continue;
    const std::string_view source = tag.attribute("Source");
    if (source.empty()) throw InputError({file, tag.line}, "has a Piece without Source", "the file is damaged");
    const fs::path folder = fs::path(file).parent_path();
    pieces.push_back((folder / unescaped(std::string(source))).string());
    if (!options.allow_outside && !lies_within(pieces.back(), folder.empty() ? "." : folder.string()))
      throw InputError({file, tag.line},
                       "names the piece " + unescaped(std::string(source)) + ", outside of its own folder",
                       "move it there, or allow it with --allow-outside");
  }
  if (!is_pvtu) throw InputError({file, 0}, "is not of type PUnstructuredGrid", "name a .pvtu of triangle meshes");
  if (!is_complete) throw InputError({file, 0}, "ends before </VTKFile>", "it was not written completely");
  if (pieces.empty()) throw InputError({file, 0}, "names no pieces", "the file is damaged");
  return pieces;
}

std::vector<std::string> pvtu_pieces(const std::string& path, const ReadOptions& options) {
  return parse_pvtu(path, read_file(path), options);
}

std::vector<Mesh> read_pieces(const std::string& path, const ReadOptions& options) {
  std::vector<Mesh> pieces;
  for (const std::string& piece : pvtu_pieces(path, options)) pieces.push_back(read_vtu(piece));
  return pieces;
}

Mesh read_pvtu(const std::string& path, const ReadOptions& options) {
  MergeFaults faults;
  Mesh mesh;
  try {
    mesh = merge_pieces(read_pieces(path, options), faults);
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    throw InputError({path, 0}, error.what(), "driftmesh writes such files; from other programs, save a .vtu");
  }
  if (faults.count != 0)
    throw InputError({path, 0}, "its pieces do not fit together: " + faults.first[0],
                     "driftmesh check lists all faults");
  return mesh;
}

}  // namespace driftmesh
