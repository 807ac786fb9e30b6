// Interpolates displacements known at scattered points over space by radial basis functions: elastic deflections from a structural solver.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/schema.h"
#include "geom/model/space_map.h"

namespace sterna {

struct ScatteredDisplacements {
  std::vector<Point> at;    ///< metres, undeformed
  std::vector<Vec3> shift;  ///< metres
};

/// Reads a text table x y z dx dy dz, one point per line, metres; separated by blanks, tabs, commas or semicolons; '#' starts a comment.
/// \throws Error(file_not_found, file_malformed with the line)
ScatteredDisplacements read_displacements(const std::filesystem::path& path);

struct RadialMapOptions {
  std::string kernel = "thin_plate";
  double radius = k_automatic;
  bool linear_part = true;
};
template <>
struct Schema<RadialMapOptions> {
  static constexpr std::string_view stage = "deform";
  static constexpr std::array fields = {
      Field<RadialMapOptions>{.name = "kernel",
                              .member = &RadialMapOptions::kernel,
                              .help = "thin_plate: r^2 log r, smoothest, far-reaching; wendland_c2: smooth bumps that end at the radius",
                              .choices = "thin_plate wendland_c2"},
      Field<RadialMapOptions>{.name = "radius",
                              .member = &RadialMapOptions::radius,
                              .unit = Unit::metre,
                              .min = 0.0,
                              .help = "radius of the functions of wendland_c2",
                              .automatic = "the diagonal of the points' box"},
      Field<RadialMapOptions>{
          .name = "linear_part",
          .member = &RadialMapOptions::linear_part,
          .help = "reproduce translations, rotations and linear changes exactly everywhere (always with thin_plate); if false, wendland_c2 does not move "
                  "geometry beyond the radius"},
  };
};

/// Interpolates displacements: D(p) = p + sum_k w_k phi(|p - x_k|) (+ linear part). Derivatives are analytic. Second derivatives of thin plates grow as the
/// logarithm of the distance at the data points and are cut off there. Based on: Wendland, Adv. Comp. Math. 4, 1995; Duchon 1977.
class RadialMap final : public SpaceMap {
 public:
  /// Takes O(n^3), for n up to 6000.
  /// \throws Error(bad_argument) if there are no points or too many, if two points at one location have different displacements, or if the system is singular
  RadialMap(const ScatteredDisplacements& data, const RadialMapOptions& options = {});
  Point point(const Point& p) const override;
  SpaceMapDerivatives derivatives(const Point& p) const override;
  std::size_t n_points() const { return centres_.size(); }

 private:
  bool is_thin_plate_;
  double radius_;
  Point origin_;  ///< origin about which coordinates are scaled by 1 / scale_
  double scale_;
  std::vector<Vec3> centres_;  ///< scaled
  std::vector<Vec3> weights_;  ///< metres
  Vec3 constant_, linear_[3];  ///< linear part of the displacement over scaled coordinates
};

}  // namespace sterna
