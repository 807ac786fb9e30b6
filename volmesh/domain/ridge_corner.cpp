#include "volmesh/domain/ridge_corner.h"

namespace sterna::volmesh {
namespace {

constexpr double k_corner_cosine = 0.3;  ///< smallest cosine between the growth lines of a corner and the normals of its virtual triangles
constexpr double k_corner_slack = 0.05;  ///< tolerance for the cosine, because growth lines of knife edges are at right angles to the middle line

}  // namespace

std::vector<Vec3> RidgeCorner::normals_across(std::size_t i) const {
  const Vec3 left = normal[i] - facet[i], right = right_normal(i) - turn[i].turned(facet[i], turn[i].angle);
  std::vector<Vec3> normals = {normal[i]};
  for (int k = 1; k < n_sectors[i]; ++k) {
    const double share = static_cast<double>(k) / n_sectors[i];
    normals.push_back(normalized(turn[i].turned(facet[i], share * turn[i].angle) + (1.0 - share) * left + share * right));
  }
  normals.push_back(right_normal(i));
  return normals;
}

Vec3 RidgeCorner::middle_normal() const {
  Vec3 sum;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::vector<Vec3> n = normals_across(i);
    for (std::size_t k = 0; k + 1 < n.size(); ++k) sum += cross(n[k + 1], n[k]);
  }
  return normalized(sum);
}

bool RidgeCorner::is_star() const {
  const Vec3 middle_line = middle_normal();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::vector<Vec3> n = normals_across(i);
    for (std::size_t k = 0; k + 1 < n.size(); ++k) {
      const Vec3 area = cross(n[k] - n[k + 1], middle_line - n[k + 1]);
      if (!(dot(normalized(area), middle_line) > k_corner_cosine) || dot(n[k], middle_line) < -k_corner_slack) return false;
    }
  }
  return true;
}

}  // namespace sterna::volmesh
