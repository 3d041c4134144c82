#include "migration/raw_archive.hpp"

namespace driftmesh {

struct RawWriter::Archive {
  SealedBytes& bytes;
};

RawWriter::RawWriter(SealedBytes& bytes) : archive_(new Archive{bytes}) {}
RawWriter::~RawWriter() = default;

void RawWriter::save(const void* data, std::size_t size) {
  archive_->bytes.append(data, size);
}

struct RawReader::Archive {
  SealReader& bytes;
};

RawReader::RawReader(SealReader& bytes) : archive_(new Archive{bytes}) {}
RawReader::~RawReader() = default;

void RawReader::load(void* to, std::size_t size) {
  archive_->bytes.read(to, size);
}

}  // namespace driftmesh
