#include "migration/raw_archive.hpp"

#include <boost/archive/archive_exception.hpp>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <streambuf>

#include "driftmesh/error.hpp"

namespace driftmesh {

static constexpr unsigned kArchiveFlags = boost::archive::no_header | boost::archive::no_codecvt;

struct RawWriter::Archive {
  /// A stream that appends to sealed bytes.
  class ByteSink : public std::streambuf {
   public:
    explicit ByteSink(SealedBytes& bytes) : bytes_(bytes) {}

   protected:
    std::streamsize xsputn(const char* data, std::streamsize size) override {
      bytes_.append(data, static_cast<std::size_t>(size));
      return size;
    }
    int_type overflow(int_type c) override {
      const char byte = traits_type::to_char_type(c);
      bytes_.append(&byte, 1);
      return c;
    }

   private:
    SealedBytes& bytes_;
  };

  explicit Archive(SealedBytes& bytes) : sink(bytes), archive(sink, kArchiveFlags) {}
  ByteSink sink;
  boost::archive::binary_oarchive archive;
};

RawWriter::RawWriter(SealedBytes& bytes) : archive_(std::make_unique<Archive>(bytes)) {}
RawWriter::~RawWriter() = default;

void RawWriter::save(const void* data, std::size_t size) {
  archive_->archive.save_binary(data, size);
}

struct RawReader::Archive {
  /// A stream that reads sealed bytes.
  class ByteSource : public std::streambuf {
   public:
    explicit ByteSource(SealReader& bytes) : bytes_(bytes) {}

   protected:
    std::streamsize xsgetn(char* to, std::streamsize size) override {
      return static_cast<std::streamsize>(bytes_.read(to, static_cast<std::size_t>(size)));
    }

   private:
    SealReader& bytes_;
  };

  explicit Archive(SealReader& bytes) : source(bytes), archive(source, kArchiveFlags) {}
  ByteSource source;
  boost::archive::binary_iarchive archive;
};

RawReader::RawReader(SealReader& bytes) : archive_(std::make_unique<Archive>(bytes)) {}
RawReader::~RawReader() = default;

void RawReader::load(void* to, std::size_t size) {
  try {
    archive_->archive.load_binary(to, size);
  } catch (const boost::archive::archive_exception& error) {
    throw Error(error.what());
  }
}

}  // namespace driftmesh
