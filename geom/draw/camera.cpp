#include "geom/draw/camera.h"

namespace sterna::draw {
namespace {

/// A view direction within this sine of the vertical has y upwards in the picture, since z would rotate with the smallest change of direction.
constexpr double k_vertical = 1e-3;

}  // namespace

Camera camera_towards(const Vec3& toward) {
  Camera camera;
  camera.toward = normalized(toward);
  const bool is_vertical = std::hypot(camera.toward.x, camera.toward.y) < k_vertical;
  const Vec3 upwards = !is_vertical ? Vec3{0, 0, 1} : Vec3{0, camera.toward.z > 0.0 ? 1.0 : -1.0, 0};
  camera.right = normalized(cross(upwards, camera.toward));
  camera.up = cross(camera.toward, camera.right);
  return camera;
}

}  // namespace sterna::draw
