// Protocol between sterna and sterna-read-container. This header includes nothing of sterna except the kinds of numbers.
//
// The arguments are the library (hdf5, netcdf, adf), then the names and labels of groups to leave out. Descriptor 3 is the file, read-only. Descriptor 4 is the
// image, a memfd. The image consists of an ImageHeader, n_nodes NodeRecords (each after its parent, the root first), text_size bytes of text, and the values,
// each aligned to k_alignment. With an outcome other than ok it consists of the header and the text only.
#pragma once

#include <cstdint>

#include "io/input/number_kind.h"

namespace sterna::io::wire {

inline constexpr int k_file_fd = 3;
inline constexpr int k_image_fd = 4;
inline constexpr std::uint64_t k_image_magic = 0x3149544e43545353;  ///< "SSTCNTI1" in memory; the last digit is the version
inline constexpr std::uint64_t k_alignment = 64;
inline constexpr std::uint32_t k_max_rank = 12;   ///< maximum number of extents of an array; the last one is the string length in an array of strings
inline constexpr std::uint32_t k_max_depth = 64;  ///< depth of nested groups; the CGNS standard uses about 10
/// Maximum ratio of unpacked size to file size, for chunks and repeated values. Meshes reach about 10.
inline constexpr std::uint64_t k_max_expansion = 200;
/// Number of bytes that may be unpacked regardless of the file size.
inline constexpr std::uint64_t k_expansion_floor = std::uint64_t{1} << 24;

enum class Outcome : std::uint32_t {
  ok = 0,
  malformed = 1,      ///< the file breaks the rules of its container
  unsupported = 2,    ///< the file uses an unsupported feature
  out_of_memory = 3,  ///< an allocation failed within the memory limit
};

/// A range of the text section.
struct Text {
  std::uint64_t begin = 0;
  std::uint64_t size = 0;
};

struct ImageHeader {
  std::uint64_t magic = k_image_magic;
  Outcome outcome = Outcome::ok;
  std::uint32_t n_nodes = 0;
  std::uint64_t text_size = 0;
  Text where, problem, hint;  ///< set for an outcome other than ok
};

enum class Role : std::uint8_t {
  group = 0,
  dataset = 1,
  attribute = 2,
  link = 3,      ///< a link by name or to another file, or a second name of a group: not followed
  left_out = 4,  ///< name or label is among the arguments
};

/// Reason why a dataset or attribute has no values: the file is malformed, or it uses an unsupported feature.
enum class Trouble : std::uint8_t { none = 0, malformed = 1, unsupported = 2 };

struct NodeRecord {
  std::uint32_t parent = 0;  ///< number of the parent; the root has its own number
  Role role = Role::group;
  Trouble trouble = Trouble::none;
  NumberKind kind = NumberKind::i4;
  std::uint8_t is_big_endian = 0;
  std::uint32_t rank = 0;
  std::uint32_t unused = 0;
  Text name, problem;
  std::uint64_t extents[k_max_rank] = {};  ///< slowest first
  std::uint64_t begin = 0, n_bytes = 0;    ///< range of the values in the image; n_bytes is the product of the extents and the size of a number
};

static_assert(sizeof(ImageHeader) == 72 && sizeof(NodeRecord) == 160);

}  // namespace sterna::io::wire
