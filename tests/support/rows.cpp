#include "tests/support/rows.h"

#include "geom/cad/fluid.h"
#include "geom/model/airfoil.h"
#include "geom/model/components.h"
#include "geom/model/shapes.h"
#include "tests/support/test_constants.h"

namespace sterna::test {

Model duct() {
  TestSectionOptions options;
  options.length = 4.0;
  options.width = 1.0;
  options.height = 2.0;
  options.upstream = 1.0;
  return make_test_section(options);
}

Model through_duct(std::span<const Model> bodies, PatchKind kind) {
  Model tunnel = duct();
  for (ModelFace& face : tunnel.faces)
    if (face.role == FaceRole::wall) face.kind = kind;
  return cad::fluid_domain(tunnel, bodies, {}, k_context).model;
}

Model blade(double trailing_edge, const std::string& naca_digits, double twist) {
  Wing wing{.name = "blade", .is_symmetric = true, .trailing_edge = trailing_edge};
  for (const double y : {1.0, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {-0.3, y, 0.0}, .chord = 0.8, .twist = twist};
    s.points = naca_airfoil(naca_digits).points;
    wing.sections.push_back(s);
  }
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  return make_wing(wing);
}

}  // namespace sterna::test
