#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

#include "app/progress_line.hpp"
#include "app/summary.hpp"
#include "base/words.hpp"
#include "study/run_json.hpp"

using namespace driftmesh;
using namespace driftmesh::app;
using namespace driftmesh::job;

TEST_CASE("Numbers in words") {
  CHECK(grouped(0) == "0");
  CHECK(grouped(999) == "999");
  CHECK(grouped(1000) == "1,000");
  CHECK(grouped(-1234567) == "-1,234,567");
  CHECK(bytes_words(999) == "999 B");
  CHECK(bytes_words(1000) == "1 kB");
  CHECK(bytes_words(999'499) == "999 kB");
  CHECK(bytes_words(999'999) == "1 MB");
  CHECK(bytes_words(1'530'000'000) == "1.53 GB");
  CHECK(duration_words(0.0421) == "0.042 s");
  CHECK(duration_words(1.5) == "1.50 s");
  CHECK(duration_words(59.96) == "60.0 s");
  CHECK(duration_words(200) == "3 min 20 s");
  CHECK(whole_seconds_words(2.1) == "3 s");
  CHECK(duration_words(7500) == "2 h 05 min");
  CHECK(rate_words(850'000) == "850 thousand");
  CHECK(rate_words(5'314'000) == "5.31 million");
  CHECK(estimate_words(999) == "999");
  CHECK(estimate_words(12'345'678) == "12,300,000");
  CHECK(estimate_words(1e20) == "1e+20");
}

TEST_CASE("The histogram is aligned, adds up and shows every angle that occurs") {
  AngleSummary shape;
  shape.bins[2] = 1;
  shape.bins[5] = 1'000'000;
  shape.bins[17] = 250'000;
  std::istringstream lines(histogram_text(shape));
  std::size_t count = 0, bar_column = std::string::npos;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto bars = std::count(line.begin(), line.end(), '#');
    CHECK(bars == (count == 2 ? 1 : count == 5 ? 50 : count == 17 ? 13 : 0));
    CHECK(line.size() <= 100);
    if (bars == 0) continue;
    if (bar_column == std::string::npos) bar_column = line.find('#');
    CHECK(line.find('#') == bar_column);
    CHECK(line.find(" - ") == 5);
  }
  CHECK(count == 18);
}

TEST_CASE("The summary names exceptions, places and an incomplete mesh") {
  RunRecord run;
  run.command = "driftmesh mesh bay.poly";
  run.input_file = "bay.poly";
  run.triangles = 1234;
  run.exceptions.push_back({"small angle of the input", 12, 10.66, {{{1, 2}}, {{3.5, 4}}, {{5, 6}}}});
  run.exceptions.push_back({"wedge", 7, 12, {{{7, 8}}}});
  run.complete = false;
  run.stopped_by = "limits.max-triangles";
  run.digest = 0xABCDEF;
  const std::string text = summary_text(run);
  for (const char* expected : {"1,234 triangles", "12 triangles, small angle of the input, from 10.6600 degrees",
                               "(1, 2) (3.5, 4) (5, 6) ...\n", "(7, 8)\n", "INCOMPLETE: stopped by --max-triangles",
                               "0000000000abcdef", "driftmesh mesh bay.poly"})
    CHECK_MESSAGE(text.find(expected) != std::string::npos, expected);
}

TEST_CASE("Times of many stages take several lines, none of which is wider than a terminal") {
  RunRecord run;
  run.seconds = 1234.5;
  const char* const names[] = {"read",   "repair",  "size",     "creeks",  "triangulate", "decompose", "map",
                               "refine", "inspect", "assemble", "convert", "write",       "plot"};
  for (const char* name : names) run.stages.push_back({name, 100.25});
  run.stages.push_back({"nothing", 0.0001});
  const std::string text = summary_text(run);
  std::istringstream lines(text.substr(text.find("time  ")));
  std::string all;
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line) && line.find("memory") != 0; ++count) {
    CHECK(line.size() <= 100);
    CHECK((count == 0 || line.find_first_not_of(' ') == 13));
    all += line + ' ';
  }
  CHECK(count == 3);
  for (const char* name : names) CHECK_MESSAGE(all.find(std::string(name) + " 100.250") != std::string::npos, name);
  CHECK(all.find("nothing") == std::string::npos);
}

TEST_CASE("The summary of a run on ranks has a row for each rank, or the extremes of many") {
  RunRecord run;
  run.subdomains = 40;
  run.ranks.resize(2);
  run.ranks[1].triangles = 7654321;
  run.ranks[0].interface_splits = 30;
  run.ranks[1].counters.splits_sent = 12;
  run.ranks[1].counters.batches_sent = 1;
  run.ranks[0].counters.hand_offs = 3;
  run.ranks[0].counters.forwarded = 5;
  run.ranks[0].counters.most_hops = 1;
  run.ranks[1].counters.most_hops = 2;
  run.ranks[1].counters.held = 4;
  std::string text = summary_text(run);
  for (const char* expected :
       {"40 subdomains on 2 ranks",
        "30 split points put on interfaces by refinement, 12 sent between ranks in 1 message",
        "3 subdomains moved between ranks",
        "5 groups of split points forwarded after a subdomain, 2 hops at most; 4 held for one", "7,654,321"})
    CHECK_MESSAGE(text.find(expected) != std::string::npos, expected);
  const std::string json = study::run_json(run);
  for (const char* expected :
       {"\"hand_offs\": 3", "\"hand_off_bytes\": 0", "\"forwarded\": 5", "\"most_hops\": 2", "\"held\": 4"})
    CHECK_MESSAGE(json.find(expected) != std::string::npos, expected);
  run.ranks.resize(100);
  run.ranks[77].times.computing = 12.5;
  text = summary_text(run);
  CHECK(text.find("12.500") != std::string::npos);
  CHECK(std::count(text.begin(), text.end(), '\n') < 50);
}

TEST_CASE("The facts of parts add up to those of the whole, even after a trip through bytes") {
  MeshFacts a, b;
  a.triangles = 10;
  a.digest = 7;
  a.shape.smallest = 20;
  a.shape.smallest_area = 3;
  a.exceptions.push_back({"wedge", 2, 15, {{{1, 2}, 15}, {{3, 4}, 16}}});
  b.triangles = 5;
  b.digest = 8;
  b.shape.smallest = 25;
  b.shape.smallest_area = 1;
  b.exceptions.push_back({"wedge", 3, 14, {{{5, 6}, 14}, {{1, 2}, 15}, {{7, 8}, 18}}});
  b.exceptions.push_back({"small angle of the input", 1, 3, {{{9, 9}, 3}}});
  ByteWriter writer;
  write_facts(writer, b);
  const auto bytes = writer.take();
  ByteReader reader(bytes);
  MeshFacts sum;
  add_facts(sum, a);
  add_facts(sum, read_facts(reader));
  CHECK(reader.at_end());
  CHECK(sum.triangles == 15);
  CHECK(sum.digest == 15);
  CHECK(sum.shape.smallest == 20);
  CHECK(sum.shape.smallest_area == 1);
  REQUIRE(sum.exceptions.size() == 2);
  CHECK(sum.exceptions[0].count == 5);
  CHECK(sum.exceptions[0].worst_angle == 14);
  REQUIRE(sum.exceptions[0].places.size() == 3);
  CHECK(sum.exceptions[0].places[0].at == Point{5, 6});
  CHECK(sum.exceptions[0].places[1].at == Point{1, 2});
  CHECK(sum.exceptions[0].places[2].at == Point{3, 4});
}

TEST_CASE("Progress in words") {
  CHECK(refining_words(1'000'000, 4'012'345, 0.4) ==
        "refining  25 %  2 s left  1,000,000 of about 4,010,000 triangles  2.50 M/s");
  CHECK(refining_words(5'000'000, 4'000'000, 1) == "refining  5,000,000 triangles  5.00 M/s");
  CHECK(refining_words(12, 1e18, 0) == "refining  12 triangles");
  CHECK(refining_words(100'000'000, 536'000'000, 40).find("triangles") < 70);
  CHECK(writing_words("out/bay.vtu", 0.4, 0) == "writing bay.vtu");
  CHECK(writing_words("out/bay.vtu", 4, 1'240'000'000) == "writing bay.vtu  4 s  1.24 GB  310 MB/s");
}
