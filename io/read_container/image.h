// The helper's side of container_wire.h: nodes are collected first, then the image is laid out and the values are read straight into it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/container/container_wire.h"

namespace sterna::io::reader {

/// Ends the reading; becomes the parent's error. `where`: a path in the file, or "the file".
struct Failure {
  wire::Outcome outcome = wire::Outcome::malformed;
  std::string where, problem, hint;
};

/// What the file's size justifies, and what is not wanted.
struct Limits {
  std::uint64_t file_size = 0;
  std::vector<std::string> left_out;

  std::uint64_t unpacked() const {
    return file_size > UINT64_MAX / wire::k_max_expansion ? UINT64_MAX : std::max(wire::k_expansion_floor, wire::k_max_expansion * file_size);
  }
  bool is_left_out(std::string_view name) const {
    for (const std::string& word : left_out)
      if (word == name) return true;
    return false;
  }
};

struct Node {
  std::uint32_t parent = 0;
  wire::Role role = wire::Role::group;
  std::string name;
  NumberKind kind = NumberKind::i4;
  bool is_big_endian = false;
  std::vector<std::uint64_t> extents;
  wire::Trouble trouble = wire::Trouble::none;
  std::string problem;
  /// Writes the values' bytes; empty with a trouble or without values.
  /// \throws Failure
  std::function<void(char* at)> fill;

  bool has_values() const { return role == wire::Role::dataset || role == wire::Role::attribute; }
  void give_up(wire::Trouble kind_of_trouble, std::string text) {
    trouble = kind_of_trouble;
    problem = std::move(text);
    fill = nullptr;
  }
  /// Of the values; a trouble is noted where it does not fit 64 bits. 0 with a trouble.
  std::uint64_t n_bytes() const;
};

class Image {
 public:
  explicit Image(const Limits& limits) : limits_(limits) {}
  /// \returns its number.
  /// \throws Failure when there are more nodes than the file has room for
  std::uint32_t add(Node node);
  const std::vector<Node>& nodes() const { return nodes_; }
  std::vector<Node>& nodes() { return nodes_; }

  /// Lays the image out in the memfd, fills it.
  /// \throws Failure when it would be larger than the file justifies
  void write();

 private:
  const Limits& limits_;
  std::vector<Node> nodes_;
};

/// Marks a node of kind and extents as too large (more than `limit` bytes), or of too many extents. \returns its bytes, 0 with a trouble
std::uint64_t check_size(Node& node, std::uint64_t limit);

/// The image of a reading that failed.
void write_failure(const Failure& failure);

/// The memory of this process in bytes of addresses, from now on.
void limit_memory(std::uint64_t n_bytes);
/// For the libraries, and what they keep of a file's structure.
inline constexpr std::uint64_t k_library_memory = std::uint64_t{1} << 30;

// One function for each library, each in its file. They add the nodes of the file at `path`, or of `bytes`.
void add_hdf5_nodes(const char* path, const Limits& limits, Image& image);
void add_netcdf_nodes(const char* path, std::string_view bytes, const Limits& limits, Image& image);
void add_adf_nodes(const char* path, const Limits& limits, Image& image);

}  // namespace sterna::io::reader
