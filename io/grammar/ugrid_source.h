// Shared parts of the UGRID (AFLR3) readers and writer: variants by file name, reading of numbers in any variant, and the .mapbc file of FUN3D
// (docs/method/formats_solvers.md, "UGRID").
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "geom/mesh/tri_mesh.h"
#include "io/input/byte_reader.h"
#include "io/input/text_scanner.h"

namespace sterna::io {

struct UgridVariant {
  bool is_text = false;
  bool is_wide = false;    ///< integers of 64 bits
  bool is_single = false;  ///< reals of 32 bits
  std::endian order = std::endian::little;
};

/// Returns the variant from the name: x.ugrid is text, x.b8.ugrid, x.lb8.ugrid, x.b8l.ugrid, x.lb8l.ugrid, x.b4.ugrid, x.lb4.ugrid are binary; ".gz" is
/// ignored.
/// \throws Error(unsupported_format) for the variants with Fortran records (r8, lr8, r4, lr4)
UgridVariant ugrid_variant(const std::filesystem::path& path);

/// Reads the numbers of a file sequentially. Members with `expected` throw Error(file_malformed) with line or byte offset.
class UgridSource {
 public:
  UgridSource(Borrowed<const FileBuffer> buffer, const UgridVariant& variant);

  /// Checks that the file has enough bytes left for n items of so many integers or reals each, so that memory allocated for them is justified.
  void require_integers(std::uint64_t n, std::size_t per_item, std::string_view expected) const { require(n, per_item * integer_bytes(), expected); }
  void require_reals(std::uint64_t n, std::size_t per_item, std::string_view expected) const { require(n, per_item * real_bytes(), expected); }

  std::int64_t integer(std::string_view expected);
  std::uint64_t count(std::string_view expected);
  /// Returns the coordinates of point `i` (from 0), which must be finite.
  Vec3 point(std::uint64_t i);
  /// Returns the coordinates of the next point, which may be nan or infinite.
  Vec3 any_point();
  /// Reads a node number and returns it less 1. \param n_nodes number of nodes in the file
  std::uint32_t node(std::uint64_t n_nodes);
  /// Skips n integers.
  void skip_integers(std::uint64_t n, std::string_view expected);

  [[noreturn]] void fail(const std::string& problem, std::string_view hint = {}) const;

 private:
  double real();
  std::size_t integer_bytes() const { return variant_.is_text ? 2 : variant_.is_wide ? 8 : 4; }  // text: at least a digit and a blank
  std::size_t real_bytes() const { return variant_.is_text ? 2 : variant_.is_single ? 4 : 8; }
  void require(std::uint64_t n, std::size_t bytes, std::string_view expected) const;

  UgridVariant variant_;
  std::optional<ByteReader> bytes_;
  std::optional<TextScanner> text_;
};

/// A line of a .mapbc file.
struct UgridPatch {
  std::int64_t condition = 0;
  std::string name;  ///< may be empty
};

/// Reads the .mapbc file beside the mesh, wing.mapbc or wing.lb8.mapbc for wing.lb8.ugrid: a count, then lines "id condition name". Empty if there is none.
/// \throws Error(file_malformed) with its line
std::filesystem::path found_mapbc(const std::filesystem::path& mesh_path);  ///< path of the .mapbc file found; empty if there is none
std::map<std::int64_t, UgridPatch> read_mapbc(const std::filesystem::path& mesh_path, const RunContext& context);

/// Returns the path that the writer uses: wing.mapbc for wing.lb8.ugrid.
std::filesystem::path mapbc_path(const std::filesystem::path& mesh_path);

/// Returns the patch kind of a FUN3D condition number (the old grid codes 3, 4, 5 too); nullopt for others.
std::optional<PatchKind> kind_of_condition(std::int64_t condition);

}  // namespace sterna::io
