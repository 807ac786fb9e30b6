// Shared functions of the volume file tests: an independent reader, bytes of files, comparisons.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/hybrid_mesh.h"
#include "tests/support/error_of.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::test {

/// The "key value" lines of tests/tools/verify_mesh.py.
struct IndependentReport {
  std::map<std::string, std::string> values;
  std::string output;  ///< the complete output, for messages
  double number(const std::string& key) const;
  bool has(const std::string& key) const { return values.count(key) > 0; }
};

/// Reads `file` with "meshio" or "vtk" of Debian's Python. nullopt: not installed, see STERNA_NEEDS.
std::optional<IndependentReport> read_independently(const std::string& reader, const std::filesystem::path& file);

/// Checks that the reader found the counts, bounds, volumes and markers of `mesh`.
void expect_same_mesh(const IndependentReport& report, const HybridMesh& mesh);

/// Writes the mesh and returns the warnings.
std::vector<std::string> warnings_of_writing(const HybridMesh& mesh, const std::filesystem::path& path);

/// Reads and writes with the format selected from the table of formats.
HybridMesh read(const std::filesystem::path& path);
void write(const HybridMesh& mesh, const std::filesystem::path& path, int threads = 2);

/// Returns `text` with the first occurrence of `from` replaced. \pre `text` contains `from`
std::string replaced(std::string text, const std::string& from, const std::string& to);

std::string bytes_of(const std::filesystem::path& path);
std::filesystem::path write_text(const std::string& name, const std::string& text);
/// Returns the names of all files in a folder, sorted.
std::vector<std::string> files_in(const std::filesystem::path& folder);

/// Returns the volume by the divergence theorem over all cells' faces; quads as triangle fans about their centres (the flux of the bilinear face).
double volume_of(const HybridMesh& mesh);
/// Returns the volume by the same theorem over the boundary faces, whose normals point outward.
double enclosed_volume(const HybridMesh& mesh);

/// Returns half a shell about a plate: prisms, pyramids, tets, triangles and quads, patches plate, farfield, side; one triangle of collapsed growth lines.
HybridMesh mixed_mesh();

/// Returns a closed body with prisms, pyramids, tetrahedra and six patches of four kinds, two of which have triangles and quads.
HybridMesh mesh_of_six_patches();

/// Checks that `back`, read from a file, has the cells, identical coordinates, boundary faces (patch by patch, in order) and patches of `mesh`.
void expect_equal_meshes(const HybridMesh& back, const HybridMesh& mesh);

/// Returns the output of a Debian program that reads sterna's files. nullopt: not installed, see STERNA_NEEDS.
std::optional<std::string> output_of_tool(const std::string& program, const std::vector<std::string>& arguments);

/// Checks that the file `victim`, truncated at many lengths and with many bytes changed, is read or refused with file_malformed or unsupported_format. The file
/// is read under the name `name`, whose extension selects the format. \param n_attempts number of lengths; about 4 times as many changes if this is small
void expect_survives_damage(const std::filesystem::path& victim, const std::string& name, std::size_t n_attempts = 400);
/// Number of attempts for files that a helper process reads, at about 20 ms each.
inline constexpr std::size_t k_few_attempts = 10;

/// Checks that meshes with all kinds of cells are unchanged after reading, and that the bytes are the same for 1, 2 and 7 threads.
/// `read(path) -> HybridMesh`, `write(mesh, path, threads)`.
template <class Read, class Write>
void expect_round_trips(const std::filesystem::path& file, const Read& read, const Write& write) {
  for (const HybridMesh& mesh : {mixed_mesh(), mesh_of_six_patches(), hexahedron_with_roof(), sphere_shell(6, {.collapsed = {0, 20, 21}}),
                                 two_shells(2, 3, 7, {.collapsed = {0, 50}})}) {
    write(mesh, file, 2);
    expect_equal_meshes(read(file), mesh);
    const std::string bytes = bytes_of(file);
    for (const int threads : {1, 7}) {
      write(mesh, file, threads);
      EXPECT_TRUE(bytes_of(file) == bytes);
    }
  }
}

}  // namespace sterna::test
