// Inside geom/cad only: runs one OpenCASCADE boolean with increasing tolerances until its result passes all checks.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/face_origins.h"
#include "geom/cad/unite.h"

namespace sterna::cad {

/// Relative tolerance of volumes, as a fraction of the sum. It is not zero, because parts that only touch lose or gain volume by the tolerance of the fuse.
inline constexpr double k_volume_share = 1e-4;
/// Largest difference between the remaining area of a part and its estimate from samples, relative to the part's area. It is twice the sampling error on wings
/// and bodies, and less than the area of a lost face of a wing or a nacelle.
inline constexpr double k_area_share = 0.05;

enum class BooleanOperation { fuse, cut, common };

struct BooleanTask {
  BooleanOperation operation = BooleanOperation::fuse;  ///< between the first part and all others
  std::string attempted;                                ///< "uniting the parts"
  std::string stage;                                    ///< stage name of the timers: "unite"
  double tolerance = k_automatic;                       ///< metres; automatic: k_boolean_ladder
  double time_limit = 0.0;                              ///< seconds, per attempt
};

struct BooleanTry {
  Model model;
  std::vector<FaceOrigin> origin_of_face;
  double volume = 0.0;   ///< m^3, set by the judge
  bool is_late = false;  ///< the time limit was exceeded
  UniteTry outcome;
};

/// Tolerances to try, as fractions of the longest side. The first one is exact, the last one is a tenth of the resolution of a mesh at a wing's leading edge.
inline constexpr std::array<double, 5> k_boolean_ladder = {0.0, 1e-7, 1e-6, 1e-5, 1e-4};

/// Sets outcome.problem and outcome.locations of an attempt that is to be rejected, and its volume.
using Judge = std::function<void(BooleanTry&)>;

/// Returns the first attempt that `judge` accepts, or nothing if there is none. All attempts are added to `tries`. The tolerances of the ladder are fractions
/// of `size`, the longest side.
/// \throws Error(geometry_failed) for an attempt that exceeds the time limit, Error(cancelled)
std::optional<BooleanTry> climb(const BooleanTask& task, const std::vector<BooleanPart>& parts, double size, const Judge& judge, std::vector<UniteTry>& tries,
                                const RunContext& context);

/// Tests for defects that any result may have: faults of OpenCASCADE's check, and free edges (their locations are stored in outcome.locations). Returns the
/// first one; empty if there is none. Then measures the remaining area of each part, m^2, and the volume of the result. \p what is its name in messages:
/// "half". \pre one entry of `areas` per part, 0
std::string measure_result(BooleanTry& result, const std::string& what, std::vector<double>& areas, const RunContext& context);

/// Returns the longest side of the largest part.
double size_of(const std::vector<BooleanPart>& parts);
/// Returns "a", "b", "c".
std::string names_of(const std::vector<BooleanPart>& parts);
/// Formats a number for messages with six digits.
std::string number_text(double value);

}  // namespace sterna::cad
