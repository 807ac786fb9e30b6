// Gmsh MSH 2.0 to 2.2 and 4.1, text and binary (docs/method/formats_surfaces.md, "Gmsh MSH"): parser shared by the surface reader and the volume reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "io/input/file_buffer.h"

namespace sterna::io {

/// First-order element types of Gmsh.
inline constexpr std::int64_t k_msh_triangle = 2;
inline constexpr std::int64_t k_msh_quad = 3;
inline constexpr std::int64_t k_msh_tetrahedron = 4;
inline constexpr std::int64_t k_msh_hexahedron = 5;
inline constexpr std::int64_t k_msh_prism = 6;
inline constexpr std::int64_t k_msh_pyramid = 7;

/// Receives the contents in file order.
class MshSink {
 public:
  virtual ~MshSink() = default;
  virtual void reserve_points(std::size_t n) = 0;
  /// Points are numbered from 0 in the order of the calls.
  virtual void add_point(const Vec3& p) = 0;
  /// Returns true if add_point() accepts coordinates that are nan or infinite; otherwise such a file is malformed.
  virtual bool takes_any_point() const { return false; }
  /// Sets the patch of the following faces: the name of their physical group, else "patch_<number>" of the group, else of the entity.
  virtual void set_patch(std::string_view name) = 0;
  /// Adds a triangle or quad of any order, by its corners.
  virtual void add_face(std::span<const std::uint32_t> corners) = 0;
  /// Adds a first-order volume element. \param nodes in Gmsh's order, which equals that of CGNS
  virtual void add_cell(std::int64_t type, std::span<const std::uint32_t> nodes) = 0;
  /// Reports a second-order volume element.
  virtual void add_curved_cell() = 0;
};

/// Reads the whole file. \returns true if a physical group of dimension 2 with faces has a name
/// \throws Error file_malformed (line, or byte offset in binary sections), unsupported_format (other versions, partitions, unknown elements)
bool parse_msh(const FileBuffer& buffer, const RunContext& context, MshSink& sink);

}  // namespace sterna::io
