// Drawings of classified bodies as SVG: invisible faces covered, feature edges thick, vertices coloured by class, growth directions as thin lines.
#pragma once

#include <string>

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::test {

/// Returns an orthographic view from direction `from` (towards the viewer), z upwards. `line_share`: length of the direction lines over the body length.
std::string draw_classes(const volmesh::LayerBase& base, const volmesh::Classification& classes, const volmesh::Envelope& envelope, const Vec3& from,
                         double line_share = 0.1);

}  // namespace sterna::test
