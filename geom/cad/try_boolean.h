// Inside geom/cad only: one boolean of OpenCASCADE with growing tolerances until its result is a model that nobody objects to.
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

/// Volumes agree to this share of the sum: parts that only touch lose or gain by the tolerance of the fuse.
inline constexpr double k_volume_share = 1e-4;
/// Area of a part that a boolean may leave more or less than samples tell, of the part's area: twice what sampling errs on wings and bodies. A lost face of a
/// wing or a nacelle is more.
inline constexpr double k_area_share = 0.05;

enum class BooleanOperation { fuse, cut, common };

struct BooleanTask {
  BooleanOperation operation = BooleanOperation::fuse;  ///< of the first part with all others
  std::string attempted;                                ///< "uniting the parts"
  std::string stage;                                    ///< of the timers: "unite"
  double tolerance = k_automatic;                       ///< metres; automatic: the ladder
  double time_limit = 0.0;                              ///< seconds, of a try
};

struct BooleanTry {
  Model model;
  std::vector<FaceOrigin> origin_of_face;
  double volume = 0.0;   ///< m^3, for those who judge it to set
  bool is_late = false;  ///< the time limit ended it
  UniteTry outcome;
};

/// Tolerances that are tried, as shares of the longest side: exact first, the last is a tenth of what a mesh of a wing's leading edge resolves.
inline constexpr std::array<double, 5> k_boolean_ladder = {0.0, 1e-7, 1e-6, 1e-5, 1e-4};

/// Sets outcome.problem and outcome.places of a try that is not to be taken, and its volume.
using Judge = std::function<void(BooleanTry&)>;

/// The first try that `judge` takes; nothing where none is; all are added to `tries`. `size`: the longest side that the ladder is a share of.
/// \throws Error(geometry_failed) for a try that takes too long, Error(cancelled)
std::optional<BooleanTry> climb(const BooleanTask& task, const std::vector<BooleanPart>& parts, double size, const Judge& judge, std::vector<UniteTry>& tries,
                                const RunContext& context);

/// The first objection that any result may meet: faults of OpenCASCADE's check, free edges (their places go to outcome.places); empty where there is none. Then
/// the areas that are left of each part, m^2, and the volume of the result are measured. \p what names it in messages: "half".
/// \pre one entry of `areas` per part, 0
std::string measure_result(BooleanTry& result, const std::string& what, std::vector<double>& areas, const RunContext& context);

/// Longest side of the largest part.
double size_of(const std::vector<BooleanPart>& parts);
/// "a", "b", "c"
std::string names_of(const std::vector<BooleanPart>& parts);
/// For messages: six digits.
std::string number_text(double value);

}  // namespace sterna::cad
