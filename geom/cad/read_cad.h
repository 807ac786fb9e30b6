// Reads CAD files into models: STEP, IGES and BREP with names, colours, layers and units, repaired where necessary, with a report of each repair.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/cad_format.h"
#include "geom/model/model.h"

namespace sterna {

struct ReadCadOptions {
  double unit = k_automatic;  ///< metres for 1 unit of the file's numbers
  bool heal = true;
  double sew_tolerance = k_automatic;  ///< metres
  double small = k_automatic;          ///< metres
  bool cap = false;
  std::string sheets = "automatic";
  std::string fluid = "automatic";
  double time_limit = 600.0;  ///< seconds
};
template <>
struct Schema<ReadCadOptions> {
  static constexpr std::string_view stage = "read_cad";
  using T = ReadCadOptions;
  static constexpr std::array fields = {
      Field<T>{.name = "unit",
               .member = &T::unit,
               .unit = Unit::metre,
               .min = 1e-9,
               .max = 1e6,
               .help = "length of one unit of the file's numbers, in metres; replaces the unit of the header",
               .automatic = "unit of the header; 1 for BREP, which has no unit"},
      Field<T>{.name = "heal", .member = &T::heal, .help = "repair borders, orientation, gaps, small and duplicate faces"},
      Field<T>{.name = "sew_tolerance",
               .member = &T::sew_tolerance,
               .unit = Unit::metre,
               .min = 1e-9,
               .max = 1.0,
               .help = "largest gap between faces that is closed by joining their edges",
               .automatic =
                   "the smallest tolerance up to 1e-5 of the longest side that closes the most edges; edges with common ends also across 1 % of their length"},
      Field<T>{.name = "small",
               .member = &T::small,
               .unit = Unit::metre,
               .min = 0.0,
               .max = 1.0,
               .help = "edges shorter and face strips narrower than this are removed",
               .automatic = "1e-6 of the longest side"},
      Field<T>{.name = "cap",
               .member = &T::cap,
               .help = "close flat openings of shells with plane faces, named after the component: ends of blades and ducts, planes of symmetry"},
      Field<T>{
          .name = "sheets",
          .member = &T::sheets,
          .help =
              "treatment of open shells and loose faces beside closed solids. automatic: removes, with a warning, flat shells, shells within a solid and "
              "shells "
              "that share an edge with a solid (sketches, construction planes); keep: keeps all; drop: removes all; otherwise name patterns of the shells to "
              "remove: \"sketch*, plane 1\""},
      Field<T>{.name = "fluid",
               .member = &T::fluid,
               .help = "side of the outermost closed solids on which the fluid lies: around bodies, or inside a duct or a complete domain; solids within "
                       "others are bodies. automatic: outside",
               .choices = "automatic outside inside"},
      Field<T>{.name = "time_limit", .member = &T::time_limit, .unit = Unit::second, .min = 1.0, .max = 1e6, .help = "time limit for reading and repairing"},
  };
};

/// One repair made by healing.
struct CadRepair {
  std::string what;  ///< "small edge removed"
  Point location;
  double value = 0.0;  ///< metres: the gap or length that was repaired; 0 if not applicable
};

/// Free edge of an open shell.
struct CadFreeEdge {
  EdgeId edge;
  FaceId face;
  Point location;  ///< midpoint of the edge
  double length = 0.0;
};

/// Connected free edges.
struct CadOpening {
  std::vector<EdgeId> edges;
  bool is_loop = false;  ///< each corner has two free edges
  bool is_flat = false;  ///< in a plane, to 1e-4 of the length: `cap` would close a flat loop
  Point location;        ///< mean of its corners
  Vec3 normal;           ///< normal of the plane, if flat
  double length = 0.0;   ///< total length of the edges, metres
};

struct CadReport {
  cad::CadFormat format = cad::CadFormat::step;
  std::string file_unit;  ///< name of the unit in the file; "none" for BREP
  double unit = 1.0;      ///< metres for 1 unit of the file, as applied
  std::size_t n_faces = 0;
  std::size_t n_closed = 0;       ///< closed solids
  std::size_t n_open = 0;         ///< shells with free edges, and loose faces
  std::size_t n_named_parts = 0;  ///< solids, shells and instances with names from the file
  std::size_t n_named_faces = 0;
  std::vector<CadRepair> repaired;
  std::vector<CadFreeEdge> free_edges;
  std::vector<CadOpening> openings;   ///< the same free edges grouped by connectivity
  std::vector<ErrorLocation> faults;  ///< faults still reported by OpenCASCADE's check
  std::vector<std::string> warnings;
  bool is_closed() const { return n_open == 0 && n_closed > 0; }
};

struct CadFile {
  Model model;
  CadReport report;
};

namespace cad {

/// Reads the uncompressed bytes of a file. `source` is its name for messages; its stem is the name of components that have none. A file without faces is
/// rejected. Placed instances of assemblies become separate components, named after the instance, else the product; faces without a name get the name of their
/// component. Shells that cannot be closed are not an error: they are listed in the report, and each warning also goes to the log.
/// \throws Error file_malformed, geometry_failed (OpenCASCADE gave up, the time limit), cancelled.
CadFile read_cad_bytes(std::string_view bytes, CadFormat format, const std::string& source, const ReadCadOptions& options, const RunContext& context);

}  // namespace cad

/// Returns a human-readable report of several lines: format, unit, faces, solids, names, closed or not, repairs, openings.
std::string to_text(const CadReport& report);

}  // namespace sterna
