// The family rule of docs/method/quality.md, "Mesh families": checks if meshes are members of one family, each finer than the previous one by the same factor
// in every direction.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// Quantities of one mesh that the family rule compares. An absent value is unknown: the mesh was read from a file without columns, or without its manifest.
struct FamilyMember {
  std::string name;  ///< human-readable: a file name, or "mesh 2"
  std::int64_t nodes = 0;
  std::int64_t wall_faces = 0;
  double wall_edge = 0.0;                                    ///< m: mean edge length of the wall faces; 0: no wall faces
  Box box;                                                   ///< bounding box of all nodes, which is that of the farfield
  std::vector<std::pair<std::string, std::string>> patches;  ///< name and kind, by name
  std::optional<int> layers;                                 ///< layers of the tallest columns
  std::optional<double> first_height;                        ///< m: smallest requested first height
  std::optional<double> measured_first;                      ///< m: median length of the first edge of the growth lines
  std::optional<double> growth;                              ///< largest requested growth ratio
  std::optional<double> measured_growth;                     ///< mean ratio of consecutive steps of a growth line; median over the lines
  std::optional<int> constant_layers;  ///< number of equal first steps of a growth line, including the first (1: it grows from the wall); median over the lines
  std::optional<double> tet_growth;    ///< requested growth of tetrahedra, from the manifest
  std::optional<double> refinement;    ///< requested refinement relative to the family, from the manifest
};

/// Computes every quantity that follows from the mesh itself. Parallel.
FamilyMember family_member(const HybridMesh& mesh, std::string name, const RunContext& context);

struct FamilyTolerances {
  double factor = k_automatic;
  double nodes = 0.1;
  double wall_edge = 0.05;
  double first_height = 0.02;
  double measured_first = 0.05;
  double layers = 1.0;
  double growth = 0.02;
  double measured_growth = 0.1;
  double tet_growth = 0.02;
  double box = 0.01;
  double fail = 3.0;
};

/// Result of one rule for two consecutive members.
struct FamilyRule {
  std::string name;   ///< JSON key: "first_height"
  std::string title;  ///< human-readable
  GateState state = GateState::not_checked;
  std::string reason;                       ///< reason why the rule was not checked, or description of the difference
  double coarse = 0.0, fine = 0.0;          ///< values of the two members
  double value = 0.0, expected = 0.0;       ///< compared quantities: two ratios, numbers of layers, or growth - 1
  double deviation = 0.0, tolerance = 0.0;  ///< pass up to the tolerance, warn up to `fail` times it
};

struct FamilyStep {
  std::string coarse, fine;                             ///< names of the two members
  double factor = 0.0;                                  ///< refinement per direction: the requested factor, else from wall edges
  std::string factor_from;                              ///< "the option factor", "the requested refinements", "the mean wall edges", "the nodes"
  double factor_by_nodes = 0.0, factor_by_edges = 0.0;  ///< 0: unknown
  std::vector<FamilyRule> rules;
};

struct FamilyReport {
  std::vector<FamilyMember> members;
  std::vector<FamilyStep> steps;
  GateState state() const;  ///< the worst of all rules
};

/// Checks consecutive members, from coarse to fine.
/// \throws Error(bad_argument) for fewer than two members, or for a member that is not finer than the previous one
FamilyReport check_family(std::vector<FamilyMember> members, const FamilyTolerances& tolerances);

/// Returns human-readable tables: the members, then each step with its rules.
std::string to_text(const FamilyReport& report);
/// Returns JSON with schema "sterna-family-1", described in docs/quality_gates.md.
std::string to_json(const FamilyReport& report);

template <>
struct Schema<FamilyTolerances> {
  using O = FamilyTolerances;
  static constexpr std::string_view stage = "check_family";
  static constexpr std::array fields = {
      Field<O>{.name = "factor",
               .member = &O::factor,
               .min = 1.01,
               .max = 10.0,
               .help = "ratio of the edge lengths of a member and the next finer member",
               .automatic = "ratio of the requested refinements, else of the mean wall edges"},
      Field<O>{
          .name = "nodes",
          .member = &O::nodes,
          .min = 0.0,
          .max = 1.0,
          .help = "allowed relative deviation of the factor by nodes (cube root of their ratio); 0.1 is a third of the node count, which workshops accept"},
      Field<O>{.name = "wall_edge",
               .member = &O::wall_edge,
               .min = 0.0,
               .max = 1.0,
               .help = "allowed relative deviation of the factor by mean wall edges: model edges are divided into whole numbers of edges"},
      Field<O>{.name = "first_height",
               .member = &O::first_height,
               .min = 0.0,
               .max = 1.0,
               .help = "allowed relative deviation of the ratio of requested first heights, as in gate G11"},
      Field<O>{.name = "measured_first",
               .member = &O::measured_first,
               .min = 0.0,
               .max = 1.0,
               .help = "allowed relative deviation of the ratio of median first heights in the mesh: growth lines lean, more so on a coarser wall"},
      Field<O>{.name = "layers",
               .member = &O::layers,
               .min = 0.0,
               .max = 10.0,
               .help = "allowed rounding of the numbers of layers: 1 = half a layer in each of the two meshes"},
      Field<O>{.name = "growth",
               .member = &O::growth,
               .min = 0.0,
               .max = 1.0,
               .help = "allowed relative deviation of the logarithm of the requested growth from that of r^(1/f)"},
      Field<O>{.name = "measured_growth",
               .member = &O::measured_growth,
               .min = 0.0,
               .max = 1.0,
               .help = "as growth, for the median growth in the mesh: heights follow the wall edges, and numbers of layers are rounded"},
      Field<O>{.name = "tet_growth",
               .member = &O::tet_growth,
               .min = 0.0,
               .max = 1.0,
               .help = "allowed relative deviation of the tetrahedra's growth minus 1 in the finer mesh from (g - 1)/f; g: growth in the coarser mesh, f: "
                       "refinement factor"},
      Field<O>{
          .name = "box",
          .member = &O::box,
          .min = 0.0,
          .max = 1.0,
          .help =
              "allowed deviation of the sides of the farfield's box, as a share of its longest side: a sphere of other triangles has a slightly different box"},
      Field<O>{.name = "fail",
               .member = &O::fail,
               .min = 1.0,
               .max = 1000.0,
               .help = "factor on the tolerances: a deviation above factor x tolerance is a FAIL, a smaller deviation above the tolerance is a warning"},
  };
};

}  // namespace sterna
