// The classic format: lists of dimensions, attributes and variables, all big endian; each variable's values lie in one piece.
#include "io/netcdf_source.h"

#include <array>
#include <vector>

#include "io/byte_reader.h"
#include "io/hdf5_source.h"

namespace sterna::io {
namespace {

constexpr std::uint32_t k_dimensions = 10;
constexpr std::uint32_t k_variables = 11;
constexpr std::uint32_t k_attributes = 12;
constexpr std::uint64_t k_max_rank = 1024;  // NC_MAX_VAR_DIMS

class ClassicReader {
 public:
  explicit ClassicReader(const FileBuffer& buffer) : reader_(buffer, std::endian::big), buffer_(buffer) {
    reader_.skip(3);
    version_ = reader_.read<std::uint8_t>("the version of a NetCDF file");
    if (version_ != 1 && version_ != 2 && version_ != 5) reader_.fail("found the NetCDF version " + std::to_string(version_) + ", expected 1, 2 or 5");
    wide("the number of records");
  }

  void read(std::map<std::string, NumberArray>& attributes, std::map<std::string, NumberArray>& variables) {
    std::vector<std::uint64_t> dimensions;
    for (std::uint64_t n = list(k_dimensions, "dimensions"); n > 0; --n) {
      name();
      dimensions.push_back(wide("the length of a dimension"));
    }
    read_attributes(attributes);
    for (std::uint64_t n = list(k_variables, "variables"); n > 0; --n) {
      const std::string variable = name();
      NumberArray array{.order = std::endian::big, .source = buffer_.source, .where = "variable \"" + variable + "\""};
      const std::uint64_t rank = wide("the number of dimensions of a variable");
      if (rank > k_max_rank) reader_.fail("found a variable of " + std::to_string(rank) + " dimensions");
      bool has_records = false;
      for (std::uint64_t k = 0; k < rank; ++k) {
        const std::uint64_t dimension = wide("a dimension's number");
        if (dimension >= dimensions.size()) reader_.fail("found the dimension " + std::to_string(dimension) + " of " + std::to_string(dimensions.size()));
        array.extents.push_back(dimensions[dimension]);
        has_records = has_records || dimensions[dimension] == 0;
      }
      std::map<std::string, NumberArray> ignored;
      read_attributes(ignored);
      array.kind = kind();
      wide("the size of a variable");  // redundant, and wrong by rule beyond 4 GiB
      const std::uint64_t begin = version_ == 1 ? reader_.read<std::uint32_t>("the place of a variable") : reader_.read<std::uint64_t>("the place of a variable");
      if (has_records) continue;  // unlimited dimensions: no part of a mesh
      std::uint64_t n_bytes = 0;
      if (__builtin_mul_overflow(count_of(array.extents, array.source, array.where), byte_size(array.kind), &n_bytes)) array.fail("the number of bytes does not fit 64 bits");
      const std::uint64_t size = buffer_.bytes.size();
      if (begin > size || n_bytes > size - begin)
        throw_malformed(buffer_.source, array.where, "its " + std::to_string(n_bytes) + " bytes from byte " + std::to_string(begin) + " leave the file of " + std::to_string(size) + " bytes",
                        "the file may have been cut short: copy or write it again");
      array.bytes = buffer_.text().substr(begin, n_bytes);
      variables[variable] = std::move(array);
    }
  }

 private:
  /// Counts and lengths: 64 bits in CDF-5.
  std::uint64_t wide(std::string_view expected) { return version_ == 5 ? reader_.read<std::uint64_t>(expected) : reader_.read<std::uint32_t>(expected); }

  /// Number of entries of a list, each of which takes at least 8 bytes.
  std::uint64_t list(std::uint32_t tag, std::string_view what) {
    const std::uint32_t found = reader_.read<std::uint32_t>(what);
    const std::uint64_t n = wide(what);
    if (found == 0 && n == 0) return 0;
    if (found != tag) reader_.fail("found the list " + std::to_string(found) + ", expected " + std::to_string(tag) + ": the " + std::string(what));
    reader_.require(n, 8, what);
    return n;
  }

  std::string_view padded(std::uint64_t n, std::string_view expected) {
    reader_.require(n, 1, expected);
    const std::string_view bytes = buffer_.text().substr(reader_.offset(), n);
    reader_.skip(n);
    const std::uint64_t padding = (4 - n % 4) % 4;
    reader_.require(padding, 1, expected);
    reader_.skip(padding);
    return bytes;
  }

  std::string name() { return std::string(padded(wide("the length of a name"), "a name")); }

  NumberKind kind() {
    constexpr std::array<NumberKind, 12> k_kinds = {NumberKind::i1, NumberKind::i1, NumberKind::text, NumberKind::i2, NumberKind::i4, NumberKind::f4,
                                                    NumberKind::f8, NumberKind::u1, NumberKind::u2,   NumberKind::u4, NumberKind::i8, NumberKind::u8};
    const std::uint32_t type = reader_.read<std::uint32_t>("a type");
    if (type < 1 || type >= k_kinds.size()) reader_.fail("found the type " + std::to_string(type) + ", expected 1 to 11");
    return k_kinds[type];
  }

  void read_attributes(std::map<std::string, NumberArray>& attributes) {
    for (std::uint64_t n = list(k_attributes, "attributes"); n > 0; --n) {
      const std::string attribute = name();
      NumberArray array{.order = std::endian::big, .source = buffer_.source, .where = "attribute \"" + attribute + "\""};
      array.kind = kind();
      const std::uint64_t count = wide("the length of an attribute");
      reader_.require(count, byte_size(array.kind), "an attribute");
      array.extents = {count};
      array.bytes = padded(count * byte_size(array.kind), "an attribute");
      attributes[attribute] = std::move(array);
    }
  }

  ByteReader reader_;
  const FileBuffer& buffer_;
  std::uint8_t version_ = 0;
};

bool is_classic(std::string_view bytes) { return bytes.starts_with("CDF"); }

}  // namespace

bool is_netcdf(std::string_view bytes) { return is_classic(bytes) || is_hdf5(bytes); }

NetcdfSource::NetcdfSource(const FileBuffer& buffer) {
  if (is_classic(buffer.text())) {
    ClassicReader(buffer).read(attributes_, variables_);
  } else if (is_hdf5(buffer.text())) {
    hdf5_ = std::make_unique<Hdf5Source>(buffer);
    group_ = std::make_unique<Hdf5Object>(hdf5_->root());
    attributes_ = group_->attributes;
  } else {
    throw_malformed(buffer.source, "byte 0", "found " + quoted_excerpt(buffer.text().substr(0, 8)) + ", expected the beginning of a NetCDF file");
  }
}

NetcdfSource::~NetcdfSource() = default;

bool NetcdfSource::has(const std::string& variable) const { return hdf5_ ? group_->find(variable) != nullptr : variables_.count(variable) > 0; }

NumberArray NetcdfSource::data(const std::string& variable) const {
  if (!hdf5_) return variables_.at(variable);
  const Hdf5Object object = hdf5_->child(*group_, variable);
  NumberArray array = hdf5_->data(object);
  array.where = "variable \"" + variable + "\"";
  return array;
}

}  // namespace sterna::io
