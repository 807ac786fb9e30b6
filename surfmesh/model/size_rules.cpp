#include "surfmesh/model/size_rules.h"

#include <array>

#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {
namespace {

constexpr std::string_view k_all_patches = "the value for all patches";
constexpr std::array k_size_rule_options = {
    RuleOption{.name = "max_edge", .help = "target length of the longest edges", .automatic = k_all_patches},
    RuleOption{.name = "min_edge", .help = "shortest edge length that curvature and narrow regions can require", .automatic = k_all_patches},
    RuleOption{.name = "curvature_angle", .help = "largest angle of the curved surface spanned by an edge", .automatic = k_all_patches},
    RuleOption{.name = "chord_error",
               .help = "largest distance of triangle centres from the surface; smaller features need not be resolved",
               .automatic = k_all_patches},
    RuleOption{.name = "leading_edge_factor", .help = "edge length at leading edges, relative to the longest edge", .automatic = k_all_patches},
    RuleOption{.name = "trailing_edge_factor", .help = "edge length at trailing edges, relative to the longest edge", .automatic = k_all_patches},
    RuleOption{.name = "trailing_edge_cells", .help = "number of cells across the base of blunt trailing edges", .automatic = k_all_patches},
    RuleOption{.name = "leading_edge_chordwise", .automatic = k_all_patches},
    RuleOption{.name = "leading_edge_stretch", .automatic = k_all_patches},
    RuleOption{.name = "leading_edge_growth", .automatic = k_all_patches},
    RuleOption{.name = "trailing_edge_chordwise", .automatic = k_all_patches},
    RuleOption{.name = "trailing_edge_stretch", .automatic = k_all_patches},
    RuleOption{.name = "trailing_edge_growth", .automatic = k_all_patches},
};

}  // namespace

OptionTable size_rule_options(Rule& rule) {
  SurfaceMeshOptions of_all;
  return sterna::options_of(rule, k_size_rule_options, sterna::options_of(of_all));
}

}  // namespace sterna::surfmesh
