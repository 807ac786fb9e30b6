// Round trips of volume meshes: a mesh with every kind of cell and six patches, and comparisons that depend on the data a format keeps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::test {

/// Returns mixed_mesh() with its side split: patches plate, farfield, west, east, symmetry, slip_north, with `suffix` appended to the names.
HybridMesh six_patch_mesh(const std::string& suffix = {});

/// Node order that a format keeps for cells: identical, or rotated within the same cell (formats that store faces).
enum class CellOrder { same, rotated };
/// Patch kinds that a format keeps: the kinds themselves, or only names from which kind_of_name() derives the kinds.
enum class Kinds { kept, by_name };

/// Checks `back`, which was read from a file of `mesh`: identical points, cells of each kind in order, the same boundary faces (in any order) in patches of the
/// same names and kinds; all boundary faces outwards.
void expect_same_after_reading(const HybridMesh& back, const HybridMesh& mesh, CellOrder order, Kinds kinds = Kinds::kept);

/// Writes, reads, compares; the bytes are the same for 2 and 7 threads, and (CellOrder::same) for columns and explicit cells. An old `path` is removed first.
void expect_round_trip(const HybridMesh& mesh, const std::filesystem::path& path, CellOrder order, Kinds kinds = Kinds::kept);

/// Returns all bytes of a file, or of all files in a folder (with their names, sorted).
std::string all_bytes(const std::filesystem::path& path);

/// Reads every k-th truncated and every k-th damaged version of the file. Each version must be read, or refused with file_malformed, unsupported_format or
/// overflow.
void expect_no_crash_on_damage(const std::filesystem::path& path, std::size_t k);

/// Limits files of this process to `n` bytes during its lifetime: simulates a full disk, also for root.
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
