#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <string_view>

#include "base/xml_text.hpp"
#include "io/file_sink.hpp"
#include "io/hdf5_format.hpp"

namespace driftmesh {
namespace {

/// What a reader of XDMF is told about a .h5 file. The facets are a grid of their own, on the same points: dolfinx
/// looks for their tags there.
class XdmfText {
 public:
  XdmfText(const std::string& path, const Hdf5Shape& shape)
      : file_(escaped(std::filesystem::path(path).filename().string())), shape_(shape) {}

  std::string text() {
    text_ = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n";
    grid("mesh", "Triangle", "cells", 3, shape_.triangles, shape_.names.regions);
    if (shape_.lines > 0) grid("facets", "PolyLine", "facets", 2, shape_.lines, shape_.names.markers);
    return text_ + "</Domain>\n</Xdmf>\n";
  }

 private:
  template <class Value>
  void grid(const std::string& name, const std::string& type, const std::string& array, int corners,
            std::uint64_t count, const std::map<Value, std::string>& names) {
    text_ += "<Grid Name=\"" + name + "\" GridType=\"Uniform\">\n<Topology TopologyType=\"" + type +
             "\" NumberOfElements=\"" + std::to_string(count) + "\" NodesPerElement=\"" + std::to_string(corners) +
             "\">";
    item("/viz/topology/" + array, std::to_string(count) + ' ' + std::to_string(corners), "Int", 8);
    text_ += "</Topology>\n<Geometry GeometryType=\"XY\">";
    item("/geometry/vertices", std::to_string(shape_.points) + " 2", "Float", 8);
    text_ += "</Geometry>\n<Attribute Name=\"" + name + "\" AttributeType=\"Scalar\" Center=\"Cell\">";
    item("/tags/" + array, std::to_string(count), "Int", 4);
    text_ += "</Attribute>\n";
    for (const auto& [value, called] : names) information(called, value);
    text_ += "</Grid>\n";
  }

  template <class Value>
  void information(const std::string& name, Value value) {
    std::array<char, 32> digits;
    const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text_.append("<Information Name=\"").append(escaped(name)).append("\" Value=\"");
    text_.append(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()))).append("\"/>\n");
  }

  void item(const std::string& array, const std::string& extent, const char* type, int bytes) {
    text_ += "<DataItem Dimensions=\"" + extent + "\" NumberType=\"" + type + "\" Precision=\"" +
             std::to_string(bytes) + "\" Format=\"HDF\">" + file_ + ':' + array + "</DataItem>";
  }

  std::string file_;
  const Hdf5Shape& shape_;
  std::string text_;
};

}  // namespace

std::string xdmf_path(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".xdmf").string();
}

void write_xdmf(const std::string& path, const Hdf5Shape& shape) {
  FileSink sink(xdmf_path(path));
  sink.text(XdmfText(path, shape).text());
  sink.commit();
}

}  // namespace driftmesh
