#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/read_file.hpp"
#include "base/xml_text.hpp"
#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/file_beside.hpp"
#include "io/mesh_file.hpp"
#include "io/other_coordinates.hpp"
#include "io/pvtu_format.hpp"
#include "io/read_checks.hpp"
#include "io/xml_scanner.hpp"
#include "mesh/merge_pieces.hpp"

namespace driftmesh {
namespace {

namespace fs = std::filesystem;

class PvtuFile {
 public:
  explicit PvtuFile(const std::string& path) : sink_(path) {}

  void write(const std::string& path, std::int32_t pieces, const VtuArrays& arrays) {
    sink_.text(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <PUnstructuredGrid GhostLevel=\"");
    sink_.text(arrays.ghost_cells ? "1\">\n" : "0\">\n");
    sink_.text(arrays.numbers ? "    <PPointData GlobalIds=\"global_number\">\n" : "    <PPointData>\n");
    for_each_point_array(arrays, [&]<class T>(const T*, const std::string& name, std::int32_t components) {
      declare<T>(name, components);
    });
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
  void declare(const std::string& name, std::int32_t components) {
    sink_.text(std::string("      <PDataArray type=\"") + vtk_type_name<T>() + "\" Name=\"" + escaped(name) + '"');
    if (components != 1) sink_.text(" NumberOfComponents=\"" + std::to_string(components) + '"');
    sink_.text("/>\n");
  }

  FileSink sink_;
};

class PvtuParser {
 public:
  PvtuParser(const std::string& file, std::string_view bytes, const ReadOptions& options)
      : file_(file), bytes_(bytes), options_(options), scanner_(file, bytes) {}

  Pvtu parse() {
    XmlTag tag;
    bool is_pvtu = false;
    std::size_t end = 0;  // where </VTKFile> ends
    while (scanner_.next(tag)) {
      if (!tag.before.empty()) throw InputError({file_, tag.line}, "has text between its elements", kDamaged);
      if (tag.name == "VTKFile" && tag.opens) is_pvtu = tag.attribute("type") == "PUnstructuredGrid";
      if (tag.name == "VTKFile" && !tag.opens) end = scanner_.position();
      if (tag.opens) enter(tag);
    }
    if (!is_pvtu) throw InputError({file_, 0}, "is not of type PUnstructuredGrid", "name a .pvtu of triangle meshes");
    if (end == 0) throw InputError({file_, 0}, "ends before </VTKFile>", kDamaged);
    if (!std::all_of(bytes_.begin() + static_cast<std::ptrdiff_t>(end), bytes_.end(), ByteCursor::is_blank))
      throw InputError({file_, 0}, "has more behind </VTKFile>", kDamaged);
    if (pvtu_.pieces.empty()) throw InputError({file_, 0}, "names no pieces", kDamaged);
    return std::move(pvtu_);
  }

 private:
  using Path = std::vector<std::string_view>;

  void enter(const XmlTag& tag) {
    for (const std::string_view section : {"PPointData", "PCellData"})  // no piece can do without the others
      if (tag.name == "PDataArray" && tag.parents == Path{"VTKFile", "PUnstructuredGrid", section})
        declare(tag, std::string(section.substr(1)));
    if (tag.name == "Piece" && tag.parents == Path{"VTKFile", "PUnstructuredGrid"}) add_piece(tag);
  }

  void declare(const XmlTag& tag, const std::string& section) {
    const std::string_view digits = tag.attribute("NumberOfComponents", "1");
    std::uint64_t components = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), components);
    if (error != std::errc() || end != digits.data() + digits.size())
      throw InputError({file_, tag.line}, "needs NumberOfComponents=\"a number\" in <PDataArray>", kDamaged);
    pvtu_.arrays.push_back({section, std::string(tag.attribute("Name")), components});
  }

  void add_piece(const XmlTag& tag) {
    const std::string source = unescaped(std::string(tag.attribute("Source")));
    if (source.empty()) throw InputError({file_, tag.line}, "has a Piece without Source", kDamaged);
    std::string path = file_beside(file_, tag.line, "piece", source, options_);
    if (std::find(pvtu_.pieces.begin(), pvtu_.pieces.end(), path) != pvtu_.pieces.end())
      throw InputError({file_, tag.line}, "names the piece " + source + " twice", kDamaged);
    pvtu_.pieces.push_back(std::move(path));
  }

  const std::string& file_;
  std::string_view bytes_;
  const ReadOptions& options_;
  XmlScanner scanner_;
  Pvtu pvtu_;
};

}  // namespace

std::string pvtu_piece_path(const std::string& path, std::int32_t k) {
  return fs::path(path).replace_extension().string() + '_' + std::to_string(k) + ".vtu";
}

void write_pvtu(const std::string& path, std::int32_t pieces, const VtuArrays& arrays) {
  PvtuFile(path).write(path, pieces, arrays);
}

Pvtu parse_pvtu(const std::string& file, std::string_view bytes, const ReadOptions& options) {
  return PvtuParser(file, bytes, options).parse();
}

Pvtu read_pvtu_header(const std::string& path, const ReadOptions& options) {
  return parse_pvtu(path, read_file(path, kBeginsXml), options);
}

PieceFiles::PieceFiles(const std::string& path, const ReadOptions& options) {
  Pvtu pvtu = read_pvtu_header(path, options);
  paths_ = std::move(pvtu.pieces);
  arrays_ = std::move(pvtu.arrays);
}

std::size_t PieceFiles::size() const {
  return paths_.size();
}

Mesh PieceFiles::read(std::size_t k, TriangleData* data) const {
  Mesh mesh = read_vtu(paths_[k], arrays_, data);
  return_to_plane(mesh, paths_[k]);
  return mesh;
}

std::uint64_t PieceFiles::most_bytes() const {
  std::uint64_t most = 0;
  for (const std::string& path : paths_) {
    std::error_code unknown;
    const std::uintmax_t bytes = fs::file_size(path, unknown);
    if (!unknown) most = std::max<std::uint64_t>(most, bytes);
  }
  return most;
}

std::vector<Mesh> read_pieces(const std::string& path, const ReadOptions& options) {
  const PieceFiles files(path, options);
  std::vector<Mesh> pieces;
  for (std::size_t k = 0; k < files.size(); ++k) pieces.push_back(files.read(k));
  return pieces;
}

namespace {

/// Appends the data of a piece to those of the pieces before it. What not all have goes.
void append(TriangleData& all, const TriangleData& piece, bool is_first) {
  if (is_first) {
    all = piece;
    return;
  }
  std::erase_if(all, [&](const auto& named) { return !piece.contains(named.first); });
  for (auto& [name, values] : all) {
    const std::vector<double>& more = piece.at(name);
    values.insert(values.end(), more.begin(), more.end());
  }
}

void put_in_order(TriangleData& data, const std::vector<std::size_t>& order) {
  for (auto& named : data) {
    std::vector<double> values;
    values.reserve(order.size());
    for (const std::size_t t : order) values.push_back(named.second[t]);
    named.second = std::move(values);
  }
}

}  // namespace

Mesh read_pvtu(const std::string& path, const ReadOptions& options, TriangleData* data) {
  MergeFaults faults;
  Mesh mesh;
  try {
    const PieceFiles files(path, options);
    std::vector<Mesh> pieces;
    for (std::size_t k = 0; k < files.size(); ++k) {
      TriangleData own;
      pieces.push_back(files.read(k, data != nullptr ? &own : nullptr));
      if (data != nullptr) append(*data, own, k == 0);
    }
    std::vector<std::size_t> order;
    mesh = merge_pieces(pieces, faults, &order);
    if (data != nullptr) put_in_order(*data, order);
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
