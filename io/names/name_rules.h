// Conversion of patch names to the rules of a format.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

struct NameRules {
  std::string_view format;           ///< "OpenFOAM", for messages
  std::string_view forbidden;        ///< characters replaced by '_', in addition to control characters
  std::size_t max_bytes = 0;         ///< 0 = unlimited; longer names are cut between UTF-8 characters
  bool may_begin_with_digit = true;  ///< otherwise '_' is prepended
  bool may_have_blanks = true;
};

/// Returns unique names in patch order. An empty name becomes "patch_<n>" (from 1), a repeated name gets a number. Each change is logged as a warning.
std::vector<std::string> names_by_rules(const Column<PatchId, Patch>& patches, const NameRules& rules, const RunContext& context);

}  // namespace sterna::io
