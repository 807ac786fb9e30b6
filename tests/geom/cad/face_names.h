// Names of a model's faces, for tests.
#pragma once

#include <set>
#include <string>

#include "geom/model/model.h"

namespace sterna::test {

inline std::set<std::string> face_names(const Model& model) {
  std::set<std::string> names;
  for (const ModelFace& face : model.faces) names.insert(face.name);
  return names;
}

}  // namespace sterna::test
