#include "gis/mosaic_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/file_identity.hpp"
#include "base/letter_case.hpp"
#include "base/read_file.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

#ifdef DRIFTMESH_GDAL_LIBRARY

namespace {

namespace fs = std::filesystem;

std::string extension_of(const std::string& path) {
  return lower_case(fs::path(path).extension().string());
}

/// Checks the XML of a mosaic: only what is known to be harmless passes.
class MosaicCheck {
 public:
  explicit MosaicCheck(const std::string& file) : file_(file), folder_(fs::path(file).parent_path()) {}

  /// An element, and all that is in it.
  void check(const CPLXMLNode& element) const {
    static constexpr std::array<std::string_view, 24> kKnown{
        "VRTDataset",       "SRS",          "GeoTransform",    "Metadata",   "MDI",      "VRTRasterBand",
        "Description",      "NoDataValue",  "HideNoDataValue", "UnitType",   "Offset",   "Scale",
        "ColorInterp",      "SimpleSource", "ComplexSource",   "SourceBand", "SrcRect",  "DstRect",
        "SourceProperties", "NODATA",       "ScaleOffset",     "ScaleRatio", "MaskBand", "UseMaskBand"};
    const std::string_view name = element.pszValue;
    if (name == "SourceFilename") return check_source(element);
    if (std::ranges::find(kKnown, name) == kKnown.end()) fail("has an element " + std::string(name));
    if (!attribute(element, "subClass").empty()) fail("has a band that is computed");
    if (name == "Metadata" && !attribute(element, "domain").empty()) fail("has metadata of its own kind");
    if (name == "SRS") check_system(text_in(element));
    for (const CPLXMLNode* node = element.psChild; node != nullptr; node = node->psNext)
      if (node->eType == CXT_Element) check(*node);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError({file_}, what,
                     "a .vrt may only join GeoTIFFs of its own folder; gdal_translate makes a .tif of others");
  }

  static std::string attribute(const CPLXMLNode& element, const char* name) {
    for (const CPLXMLNode* node = element.psChild; node != nullptr; node = node->psNext)
      if (node->eType == CXT_Attribute && std::strcmp(node->pszValue, name) == 0) return text_in(*node);
    return "";
  }

  static std::string text_in(const CPLXMLNode& element) {
    for (const CPLXMLNode* node = element.psChild; node != nullptr; node = node->psNext)
      if (node->eType == CXT_Text) return node->pszValue;
    return "";
  }

  /// GDAL would also take the name of a file, or an address.
  void check_system(const std::string& text) const {
    const bool is_wkt = text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") == text.find('[');
    const bool is_code = text.starts_with("EPSG:") && text.find_first_not_of("0123456789", 5) == std::string::npos;
    if (!text.empty() && !is_code && (!is_wkt || text.find('[') == std::string::npos))
      fail("has a coordinate system that is neither WKT nor a code of the EPSG");
  }

  void check_source(const CPLXMLNode& element) const {
    const std::string name = text_in(element);
    const fs::path path = attribute(element, "relativeToVRT") == "1" ? folder_ / name : fs::path(name);
    const std::string extension = extension_of(name);
    if (name.find_first_of(":?<>|\"&") != std::string::npos || (extension != ".tif" && extension != ".tiff"))
      fail("names '" + name + "', which is no GeoTIFF by its name");
    if (!lies_within(path.string(), folder_.empty() ? "." : folder_.string()))
      fail("names '" + name + "', outside of its own folder");
    require_regular_file(path.string());
    if (!begins_like_tiff(path)) fail("names '" + name + "', which is no GeoTIFF");
  }

  /// So that GDAL takes it for one, too.
  static bool begins_like_tiff(const fs::path& path) {
    std::array<char, 4> begin{};
    std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
    const std::string_view bytes(begin.data(), begin.size());
    using namespace std::string_view_literals;
    return bytes == "II*\0"sv || bytes == "MM\0*"sv || bytes == "II+\0"sv || bytes == "MM\0+"sv;
  }

  const std::string& file_;
  fs::path folder_;
};

}  // namespace

bool is_mosaic_file(const std::string& path) {
  return extension_of(path) == ".vrt";
}

void require_plain_mosaic(const GdalFunctions& gdal, const std::string& path) {
  const QuietGdal quiet(gdal);
  const OwnedByUs<CPLXMLNode*> root(gdal.CPLParseXMLFile(path.c_str()),
                                    [&gdal](CPLXMLNode* node) { gdal.CPLDestroyXMLNode(node); });
  if (root == nullptr) throw InputError({path}, "is no .vrt: " + quiet.message("not XML"), "gdalbuildvrt makes one");
  for (const CPLXMLNode* node = root.get(); node != nullptr; node = node->psNext)
    if (node->eType == CXT_Element && *node->pszValue != '?') MosaicCheck(path).check(*node);
}

#endif

}  // namespace driftmesh
