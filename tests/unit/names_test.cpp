#include "pslg/names.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "base/bytes.hpp"
#include "driftmesh/error.hpp"

using namespace driftmesh;

TEST_CASE("names are those that every format can hold") {
  for (const char* good :
       {"inlet", "in let", "Gr\xC3\xBC\xC3\x9F", "\xE6\xB5\xB7", "\xF0\x9F\x8C\x8A", "domain 2", "markers", "a/b"})
    CHECK_MESSAGE(fault_of_name(good).empty(), good);
  CHECK(fault_of_name(std::string(120, 'x')).empty());
  CHECK(fault_of_name(std::string(121, 'x')).find("120 bytes") != std::string::npos);
  CHECK(fault_of_name("") == "is empty");
  for (const char* wrong : {"\xFC", "\xC3", "\xC3(", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF0\x80\x80\xAF",
                            "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\x80"})
    CHECK_MESSAGE(fault_of_name(wrong) == "is not UTF-8", wrong);
  for (const char* wrong : {"a\nb", "a\tb", "a\x7F", "\x1B[0m"})
    CHECK(fault_of_name(wrong) == "has a control character");
  CHECK(fault_of_name("a \"b\"") == "has a quote");
  for (const char* wrong : {" a", "a "}) CHECK(fault_of_name(wrong) == "begins or ends with a blank");
  for (const char* wrong : {"domain", "marker 5", "marker five", "region 0.5"})
    CHECK(fault_of_name(wrong).find(".msh") != std::string::npos);
}

TEST_CASE("each name belongs to one marker or region") {
  const auto message = [](const Names& names) {
    try {
      check_names(names, "bay.poly");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message({{{5, "inlet"}, {-7, "outlet"}}, {{0.5, "land"}}}).empty());
  CHECK(message({{{5, "inlet"}, {-7, "inlet"}}, {}}) ==
        "bay.poly: the name 'inlet' is given twice; give each marker and each region a name of its own");
  CHECK(message({{{5, "land"}}, {{0.5, "land"}}}).find("twice") != std::string::npos);
  CHECK(message({{{5, ""}}, {}}).find("is empty") != std::string::npos);
  CHECK(message({{}, {{std::numeric_limits<double>::infinity(), "far"}}}).find("is for no number") !=
        std::string::npos);
}

TEST_CASE("readers leave out what cannot be a name, or is one already") {
  Names names;
  add_marker_name(names, 5, "inlet");
  add_marker_name(names, 6, "inlet");
  add_marker_name(names, 5, "outlet");
  add_marker_name(names, 7, "marker 8");
  add_region_name(names, 2, "inlet");
  add_region_name(names, std::numeric_limits<double>::quiet_NaN(), "nowhere");
  add_region_name(names, -1.5, "land");
  CHECK(names == Names{{{5, "inlet"}}, {{-1.5, "land"}}});
}

TEST_CASE("names go from rank to rank") {
  const Names names{{{std::numeric_limits<std::int32_t>::min(), "inlet"}, {0, "Gr\xC3\xBC\xC3\x9F"}}, {{-0.1, "land"}}};
  ByteWriter writer;
  transfer_names(writer, names);
  const Bytes bytes = writer.take();
  ByteReader reader(bytes);
  Names read;
  transfer_names(reader, read);
  reader.end();
  CHECK(read == names);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ByteReader cut(std::span<const std::byte>(bytes).first(length));
    Names ignored;
    CHECK_THROWS_AS(transfer_names(cut, ignored), Error);
  }
}

TEST_CASE("numbers of names are whole texts") {
  CHECK(marker_from("-5") == -5);
  for (const char* wrong : {"", "5 ", "5.0", "x", "3000000000"}) CHECK(!marker_from(wrong));
  CHECK(region_from("-0.5") == -0.5);
  for (const char* wrong : {"", "inf", "nan", "1,5", " 1"}) CHECK(!region_from(wrong));
}
