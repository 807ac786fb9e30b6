// Size options that surface meshes of models and of triangulations have in common.
#pragma once

#include <array>
#include <numbers>
#include <string_view>

#include "geom/base/joined.h"
#include "geom/base/schema.h"

namespace sterna::surfmesh {

/// Target edge lengths, for a struct with options of a surface mesh that has a member `sizes`. Users see them among the other options of that struct.
struct SurfaceSizeOptions {
  double max_edge = k_automatic;  ///< m
  double min_edge = k_automatic;  ///< m
  double curvature_angle = 12.0 * std::numbers::pi / 180.0;
  double chord_error = k_automatic;  ///< m
  double growth = 1.2;
  double refinement = 1.0;
  double narrow = 2.0;
  double gap_cells = 0.0;
  double thickness_factor = k_automatic;
  int max_triangles = 100'000'000;
  double leading_edge_chordwise = k_automatic;  ///< m
  double leading_edge_stretch = k_automatic;
  double leading_edge_growth = 1.2;
  double trailing_edge_chordwise = k_automatic;  ///< m
  double trailing_edge_stretch = k_automatic;
  double trailing_edge_growth = 1.2;
};

/// Texts that differ between the two kinds of surface meshes.
struct SizeTexts {
  std::string_view automatic_max_edge, automatic_min_edge, chord_error, narrow, gap_cells;
};

/// The functions return the schema fields of `sizes`, in the groups in which users see them.
template <class O>
constexpr std::array<Field<O>, 7> length_fields(const SizeTexts& texts) {
  using S = SurfaceSizeOptions;
  return {{{.name = "max_edge",
            .member = inner_option<&O::sizes, &S::max_edge>(),
            .unit = Unit::metre,
            .min = 1e-9,
            .help = "largest edge length",
            .automatic = texts.automatic_max_edge},
           {.name = "min_edge",
            .member = inner_option<&O::sizes, &S::min_edge>(),
            .unit = Unit::metre,
            .min = 0.0,
            .help = "smallest edge length that curvature and narrow regions may require",
            .automatic = texts.automatic_min_edge},
           {.name = "curvature_angle",
            .member = inner_option<&O::sizes, &S::curvature_angle>(),
            .unit = Unit::radian,
            .min = 0.001,
            .max = 1.6,
            .help = "largest angle by which the surface turns along an edge"},
           {.name = "chord_error",
            .member = inner_option<&O::sizes, &S::chord_error>(),
            .unit = Unit::metre,
            .min = 1e-9,
            .help = texts.chord_error,
            .automatic = "no limit"},
           {.name = "growth",
            .member = inner_option<&O::sizes, &S::growth>(),
            .min = 1.01,
            .max = 3.0,
            .help = "largest ratio of the lengths of consecutive edges"},
           {.name = "refinement",
            .member = inner_option<&O::sizes, &S::refinement>(),
            .min = 0.01,
            .max = 100.0,
            .help = "divisor of lengths, angles and growth - 1: 1.5 for the next finer mesh of a family; give volume_mesh the same value",
            .choices = "extra_coarse=0.4444444444444444 coarse=0.6666666666666666 medium=1 fine=1.5 extra_fine=2.25"},
           {.name = "narrow", .member = inner_option<&O::sizes, &S::narrow>(), .min = 0.1, .max = 100.0, .help = texts.narrow}}};
}

template <class O>
constexpr std::array<Field<O>, 2> gap_fields(const SizeTexts& texts) {
  using S = SurfaceSizeOptions;
  return {{{.name = "gap_cells", .member = inner_option<&O::sizes, &S::gap_cells>(), .min = 0.0, .max = 20.0, .help = texts.gap_cells},
           {.name = "thickness_factor",
            .member = inner_option<&O::sizes, &S::thickness_factor>(),
            .min = 0.1,
            .max = 100.0,
            .help = "largest edge length relative to the thickness of the part",
            .automatic = "no limit"}}};
}

template <class O>
constexpr std::array<Field<O>, 1> count_fields() {
  return {{{.name = "max_triangles",
            .member = inner_option<&O::sizes, &SurfaceSizeOptions::max_triangles>(),
            .min = 1,
            .max = 2e9,
            .help = "largest number of triangles; more are an error, reported before meshing if the sizes predict it"}}};
}

/// The fields of rows beside one kind of edges. `Chordwise`, `Stretch` and `Growth`: members of SurfaceSizeOptions.
template <class O, auto Chordwise, auto Stretch, auto Growth>
constexpr std::array<Field<O>, 3> row_fields(std::array<std::string_view, 3> names, std::string_view chordwise_help) {
  return {{{.name = names[0],
            .member = inner_option<&O::sizes, Chordwise>(),
            .unit = Unit::metre,
            .min = 1e-9,
            .help = chordwise_help,
            .automatic = "no rows, or the longest edge divided by the stretch"},
           {.name = names[1],
            .member = inner_option<&O::sizes, Stretch>(),
            .min = 1.0,
            .max = 50.0,
            .help = "ratio of the longest cell along the edge to the first cell across it",
            .automatic = "no rows, or 10"},
           {.name = names[2], .member = inner_option<&O::sizes, Growth>(), .min = 1.01, .max = 1.2, .help = "ratio of the heights of consecutive rows"}}};
}

template <class O>
constexpr std::array<Field<O>, 6> edge_row_fields() {
  using S = SurfaceSizeOptions;
  return joined(
      row_fields<O, &S::leading_edge_chordwise, &S::leading_edge_stretch, &S::leading_edge_growth>(
          {"leading_edge_chordwise", "leading_edge_stretch", "leading_edge_growth"}, "first cell beside leading edges, in rows of stretched triangles"),
      row_fields<O, &S::trailing_edge_chordwise, &S::trailing_edge_stretch, &S::trailing_edge_growth>(
          {"trailing_edge_chordwise", "trailing_edge_stretch", "trailing_edge_growth"},
          "first cell beside trailing edges, on both sides, or beside the base of blunt trailing edges"));
}

}  // namespace sterna::surfmesh
