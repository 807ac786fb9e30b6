// Helper side of container_wire.h. Nodes are collected first; then the image is laid out and the values are read directly into it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/container/container_wire.h"

namespace sterna::io::reader {

/// Ends the reading; reported by the parent process as its error. `where`: a path in the file, or "the file".
struct Failure {
  wire::Outcome outcome = wire::Outcome::malformed;
  std::string where, problem, hint;
};

/// Limits derived from the file size, and names of groups to leave out.
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
  /// Writes the values' bytes; empty if there is a trouble or no values.
  /// \throws Failure
  std::function<void(char* at)> fill;

  bool has_values() const { return role == wire::Role::dataset || role == wire::Role::attribute; }
  void give_up(wire::Trouble kind_of_trouble, std::string text) {
    trouble = kind_of_trouble;
    problem = std::move(text);
    fill = nullptr;
  }
  /// Returns the number of bytes of the values; 0 if there is a trouble. Stores a trouble if the number does not fit 64 bits.
  std::uint64_t n_bytes() const;
};

class Image {
 public:
  explicit Image(const Limits& limits) : limits_(limits) {}
  /// Adds a node. \returns its number.
  /// \throws Failure if there are more nodes than the file size allows
  std::uint32_t add(Node node);
  const std::vector<Node>& nodes() const { return nodes_; }
  std::vector<Node>& nodes() { return nodes_; }

  /// Lays out the image in the memfd and fills it.
  /// \throws Failure if the image would be larger than the file size justifies
  void write();

 private:
  const Limits& limits_;
  std::vector<Node> nodes_;
};

/// Marks a node whose kind and extents give more than `limit` bytes as too large, and a node with too many extents. \returns its number of bytes, 0 if it is
/// marked
std::uint64_t check_size(Node& node, std::uint64_t limit);

/// Writes the image of a failed reading.
void write_failure(const Failure& failure);

/// Limits the address space of this process, in bytes.
void limit_memory(std::uint64_t n_bytes);
/// Memory for the libraries and their data about the file's structure.
inline constexpr std::uint64_t k_library_memory = std::uint64_t{1} << 30;

// One function per library, each in its own file. They add the nodes of the file at `path`, or of `bytes`.
void add_hdf5_nodes(const char* path, const Limits& limits, Image& image);
void add_netcdf_nodes(const char* path, std::string_view bytes, const Limits& limits, Image& image);
void add_adf_nodes(const char* path, const Limits& limits, Image& image);

}  // namespace sterna::io::reader
