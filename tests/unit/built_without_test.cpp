#include <doctest/doctest.h>

#include <string>

#include "decompose/graph_partition.hpp"
#include "driftmesh/error.hpp"
#include "geojson/geojson.hpp"
#include "io/hdf5_format.hpp"
#include "mapping/mapping_file.hpp"
#include "picture/plot.hpp"
#include "zlib/unpacker.hpp"

// What a build without some of the libraries has in their place.

using namespace driftmesh;

namespace {

template <class Call>
std::string refusal_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

/// `call` ends in one line that names the file, the library and the option that brings it.
template <class Call>
void check_refused(const std::string& library, const std::string& part, const Call& call) {
  const std::string said = refusal_of(call);
  CAPTURE(said);
  CHECK(said.starts_with("some.file: takes " + library + ", which this driftmesh was built without; "));
  CHECK(said.ends_with(", or build it with -DDRIFTMESH_" + part + "=ON"));
  CHECK(said.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("files that take a library are refused by its name without it") {
  const std::string file = "some.file";
  check_refused("HDF5", "HDF5", [&] { write_hdf5({}, {}, file); });
  check_refused("HDF5", "HDF5", [&] { static_cast<void>(read_hdf5(file)); });
  check_refused("HDF5", "HDF5", [&] { static_cast<void>(create_hdf5("some.part", file, {})); });
  check_refused("zlib", "ZLIB", [&] { Unpacker{file}; });
  check_refused("nlohmann-json", "JSON", [&] { static_cast<void>(parse_geojson(file, "{}")); });
  check_refused("nlohmann-json", "JSON", [&] { static_cast<void>(read_mapping(file, 2, 2)); });
  check_refused("cairo", "CAIRO", [&] { plot(Mesh{}, file); });
  check_refused("cairo", "CAIRO", [&] { plot(Pslg{}, file); });
}

TEST_CASE("graphs are not partitioned without METIS, and whoever asks for it is told so") {
  CHECK_FALSE(can_partition_graphs());
  const std::string said = refusal_of([] { static_cast<void>(partition_graph({}, {1, 1}, PartitionMethod::kDirect)); });
  CHECK(said.find("takes METIS, which this driftmesh was built without") != std::string::npos);
  CHECK(said.find("-DDRIFTMESH_METIS=ON") != std::string::npos);
}
