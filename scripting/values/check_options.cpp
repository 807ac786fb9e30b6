#include "scripting/values/check_options.h"

#include <cmath>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Returns the first measure of cell centres whose limits differ from the defaults; nullptr if there is none.
const MeasureInfo* own_cell_centred_limit(const GateTable& limits) {
  for (const MeasureInfo& info : measures()) {
    const GateLimits &own = limits[info.measure], &usual = info.limits;
    if (info.gate == "OF" && !(is_same(own.hard, usual.hard) && is_same(own.target, usual.target) && is_same(own.usual, usual.usual))) return &info;
  }
  return nullptr;
}

}  // namespace

std::optional<CheckSettings::Contradiction> CheckSettings::contradiction(const GateTable& limits, Consumers usual, const Names& names) const {
  const std::string requested = std::string(names.solvers) + " \"" + solvers + "\"";
  const bool is_automatic = solvers == "automatic";
  const Consumers consumers = consumers_of_solvers(solvers, usual, names.solvers);
  if (!quality) {
    const std::string problem = "quality = false switches off all QUALITY gates, ", remedy = "omit quality = false, or omit ";
    if (strict) return Contradiction{problem + "but strict treats a FAIL of them as an error", remedy + "strict"};
    if (!is_automatic) return Contradiction{problem + "but " + requested + " requests their verdict", remedy + std::string(names.solvers)};
  }
  if (cell_centred) return std::nullopt;
  const std::string off = std::string(names.no_cell_centred) + " switches off the gates of cell-centred solvers (OpenFOAM's non-orthogonality, skewness ...), ";
  const std::string omit = "omit " + std::string(names.no_cell_centred);
  if (const MeasureInfo* const info = own_cell_centred_limit(limits))
    return Contradiction{off + "but limits are given for their gate " + std::string(info->name), omit + ", or omit the limits"};
  if (!consumers.cell_centred) return std::nullopt;
  if (!is_automatic)
    return Contradiction{off + "but " + requested + " requests a verdict for a cell-centred solver",
                         omit + ", or request node-centred solvers only, such as " + std::string(names.solvers) + " \"su2\""};
  if (consumers.node_centred) return std::nullopt;  // the verdict is for node-centred solvers only
  return Contradiction{off + "but only cell-centred solvers read the format of the file",
                       omit + ", or request the verdict for node-centred solvers: " + std::string(names.solvers) + " \"su2\""};
}

CheckOptions CheckSettings::to_options(const GateTable& limits, Consumers usual, const Names& names) const {
  if (const std::optional<Contradiction> found = contradiction(limits, usual, names))
    throw Error({.code = ErrorCode::bad_argument, .attempted = "check", .problem = found->problem, .hint = found->remedy});
  CheckOptions options;
  options.consumers = consumers_of_solvers(solvers, usual, names.solvers);
  options.consumers.cell_centred = options.consumers.cell_centred && cell_centred;
  options.intersections = intersections;
  options.quality = quality;
  options.findings_per_kind = findings_per_kind;
  options.cell_centred = cell_centred;
  options.limits = limits;
  return options;
}

}  // namespace sterna::scripting
