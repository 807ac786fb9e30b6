// Round trips of volume meshes: a mesh with every kind of cell and six patches, and comparisons that know what a format keeps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::test {

/// mixed_mesh() with its side parted: patches plate, farfield, west, east, symmetry, slip_north; names are as given when `suffix` is empty.
HybridMesh six_patch_mesh(const std::string& suffix = {});

/// What a format keeps of cells: the very nodes in their order, or the same cell turned round (formats that store faces).
enum class CellOrder { same, rotated };
/// Whether the format tells the kinds of patches, or only names, from which they follow as kind_of_name() says.
enum class Kinds { kept, by_name };

/// `back` is what was read of a file of `mesh`: the same points to the bit, cells of each kind in order, the same boundary faces (in any order) in patches of
/// the same names and kinds; all boundary faces outwards.
void expect_same_after_reading(const HybridMesh& back, const HybridMesh& mesh, CellOrder order, Kinds kinds = Kinds::kept);

/// Writes, reads, compares; the bytes are the same for 2 and 7 threads, and (CellOrder::same) for columns and explicit cells. An old `path` is removed first.
void expect_round_trip(const HybridMesh& mesh, const std::filesystem::path& path, CellOrder order, Kinds kinds = Kinds::kept);

/// All bytes of a file, or of all files in a folder (with their names, sorted).
std::string all_bytes(const std::filesystem::path& path);

/// Reads every k-th shortened and every k-th damaged version of the file: each is read or refused with file_malformed, unsupported_format or overflow, nothing
/// else.
void expect_no_crash_on_damage(const std::filesystem::path& path, std::size_t k);

/// While it lives, files of this process cannot grow beyond `n` bytes: a full disk that works as root, too.
class FullDisk {
 public:
  explicit FullDisk(std::size_t n);
  ~FullDisk();
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  std::size_t old_limit_;
  void (*old_handler_)(int);
};

}  // namespace sterna::test
