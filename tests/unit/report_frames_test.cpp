#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "report/packed_frames.hpp"
#include "zlib/unpacker.hpp"

using namespace driftmesh;

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string from_base64(const std::string& base64) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : base64) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

/// A block of the page.
struct PageBlock {
  std::string attributes;
  std::string text;

  template <class Value>
  [[nodiscard]] std::vector<Value> values() const {
    const std::string packed = from_base64(text);
    Unpacker unpacker("the page");
    unpacker.begin(packed);
    std::string bytes(10'000, ' ');
    bytes.resize(unpacker.take(bytes.data(), bytes.size()));
    CHECK(unpacker.at_end());
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
};

std::vector<PageBlock> page_blocks_in(const std::string& page) {
  const std::regex block("<script type=\"text/plain\" ([^>]*)>([^<]*)</script>\n");
  std::vector<PageBlock> blocks;
  for (std::sregex_iterator it(page.begin(), page.end(), block), end; it != end; ++it)
    blocks.push_back({(*it)[1], (*it)[2]});
  return blocks;
}

Mesh one_triangle_at(double x, double y) {
  Mesh mesh;
  mesh.points = {{x, y}, {x + 2, y}, {x, y + 4}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

}  // namespace

TEST_CASE("frames are packed with one scale, one box and one middle") {
  PackedFrames frames("a<b_*.vtu", "depth", true);
  CHECK(frames.blocks().empty());
  frames.add(one_triangle_at(1e6, 0), {1, kNotANumber, 3}, 0.1);
  frames.add(one_triangle_at(1e6 + 10, 1), {-2, 0.5, std::numeric_limits<double>::infinity()}, {});
  CHECK(frames.size() == 2);
  CHECK(frames.triangles() == 2);
  const std::vector<PageBlock> blocks = page_blocks_in(frames.blocks());
  REQUIRE(blocks.size() == 7);
  CHECK(blocks[0].attributes ==
        "data-series=\"a&lt;b_*.vtu\" data-field=\"depth\" data-at=\"points\" data-middle=\"1000001 2\" "
        "data-box=\"-1 -2 11 3\" data-range=\"-2 3\"");
  CHECK(blocks[1].attributes == "data-frame=\"points\"");
  CHECK(blocks[1].values<float>() == std::vector<float>{-1, -2, 1, -2, -1, 2});
  CHECK(blocks[2].attributes == "data-frame=\"triangles\"");
  CHECK(blocks[2].values<std::int32_t>() == std::vector<std::int32_t>{0, 1, 2});
  CHECK(blocks[3].attributes == "data-frame=\"values\" data-of=\"0\" data-time=\"0.1\"");
  CHECK(blocks[3].values<float>()[2] == 3);
  CHECK(blocks[4].values<float>() == std::vector<float>{9, -1, 11, -1, 9, 3});
  CHECK(blocks[6].attributes == "data-frame=\"values\" data-of=\"1\"");
}

TEST_CASE("a mesh that stays the same is packed once") {
  PackedFrames frames("flow.pvd", "u", false);
  frames.add(one_triangle_at(0, 0), {1}, 0);
  frames.add(one_triangle_at(0, 0), {2}, 1);
  Mesh turned = one_triangle_at(0, 0);
  turned.triangles = {{1, 2, 0}};
  frames.add(turned, {2}, 2);
  frames.add(one_triangle_at(0, 0), {2}, 3);
  std::vector<std::string> values;
  for (const PageBlock& block : page_blocks_in(frames.blocks()))
    if (block.attributes.starts_with("data-frame=\"values\"")) values.push_back(block.attributes.substr(20));
  CHECK(values == std::vector<std::string>{"data-of=\"0\" data-time=\"0\"", "data-of=\"0\" data-time=\"1\"",
                                           "data-of=\"1\" data-time=\"2\"", "data-of=\"2\" data-time=\"3\""});
}

TEST_CASE("frames without a number have no range") {
  PackedFrames frames("flow.pvd", "u", false);
  frames.add(one_triangle_at(0, 0), {kNotANumber}, {});
  CHECK(page_blocks_in(frames.blocks())[0].attributes.ends_with("data-range=\"nan nan\""));
}
