// In a steady case Allrun has three steps: potentialFoam for fluxes that conserve mass; a start with first-order schemes, in parts of some iterations, until
// forces settle; the rest with second-order schemes, in parts, until forces settle again. Between the parts, judge.awk reads the output of the function
// objects.
#include "scripting/verbs/foam_run.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace sterna::scripting {
namespace {

constexpr int k_part = 50;               ///< iterations between two tests by judge.awk
constexpr int k_least_iterations = 150;  ///< smallest number of iterations for a separate start; the start has at most a third of all iterations
/// Limits of the largest velocity. A run has diverged if it exceeds k_diverged times the flow's speed, or k_diverged_inside times for contractions and jets,
/// which are faster than flow around a body. The divergence began where it exceeded k_first_sign times that limit.
constexpr double k_diverged = 10.0, k_diverged_inside = 100.0, k_first_sign = 0.5;
/// In steady flow of gases, the velocity is bounded by k_speed_bound times that limit. A run has diverged if the velocity is still above k_near_bound of the
/// bound after the start.
constexpr double k_speed_bound = 0.4, k_near_bound = 0.9;
/// A run has diverged if the velocity is near the bound in this many of 50 iterations. Fewer do not matter: in a converged run (forces changed by 0.1 %) a
/// single cell at the tail of a business jet touched the bound now and then.
constexpr int k_many_near_bound = 25;
constexpr int k_first_watched = 15, k_first_watched_in_gas = 30;  ///< iterations until the disturbance by the start has faded
constexpr double k_location_radius = 0.02;                        ///< radius of the picture of a location, over the reference length of the flow

constexpr std::string_view k_judge = R"AWK(# Reads the output of function objects, one value or force per iteration, and tests it.
# awk -f judge.awk -v what=settled -v window=200 -v share=0.002 -v drag="1 0 0" -v lift="0 0 1" FILES prints "settled PERCENT", "moving PERCENT" or "short"
# Changes of drag and lift are relative to the size of each; of lift at least to that of drag, of drag at least to a twentieth of that of lift. Without drag: one value.
# awk -f judge.awk -v what=bounded -v limit=680 -v first=340 -v from=15 -v many=0 FILES prints "diverged ITERATION SPEED FIRST_ITERATION X Y Z",
# "touched NUMBER X Y Z" (the last location) or "bounded"
# The run has diverged if more than `many` of the last 50 iterations exceed the limit, or a velocity is not a number.
/^#/ { next }
{ gsub(/[()]/, " ") }
what == "bounded" {
  # Time mag U MIN X Y Z [PROCESSOR] MAX X Y Z [PROCESSOR]
  column = NF > 11 ? 9 : 8
  speed = $column; time = $1 + 0
  if (time < from) next
  is_number = speed !~ /nan|inf/
  if (is_number && speed + 0 <= first) n_first = 0
  else if (!n_first) { n_first = time; x = $(column + 1); y = $(column + 2); z = $(column + 3) }
  last_time = time
  if (!is_number) is_lost = 1
  if (!is_number || speed + 0 > limit) { over[time] = 1; last_place = $(column + 1) " " $(column + 2) " " $(column + 3) }
  if (!n_diverged && (!is_number || speed + 0 > limit)) { n_diverged = time; diverged_speed = speed; place = n_first " " x " " y " " z }
  next
}
{
  if ($1 + 0 <= last_time) next
  last_time = $1 + 0
  ++n
  fx[n] = $2; fy[n] = NF > 3 ? $3 : 0; fz[n] = NF > 3 ? $4 : 0
}
END {
  if (what == "bounded") {
    for (time in over) if (time + 0 > last_time - 50) ++n_over
    if (is_lost || n_over + 0 > many + 0) print "diverged", n_diverged, diverged_speed, place
    else if (n_over) print "touched", n_over, last_place
    else print "bounded"
    exit
  }
  if (n < window) { print "short"; exit }
  split(drag, d, " "); split(lift, l, " ")
  for (i = n - window + 1; i <= n; ++i) {
    a[i] = drag == "" ? fx[i] : fx[i] * d[1] + fy[i] * d[2] + fz[i] * d[3]
    b[i] = drag == "" ? 0 : fx[i] * l[1] + fy[i] * l[2] + fz[i] * l[3]
    mean_a += a[i] / window; mean_b += b[i] / window
  }
  size_a = mean_a < 0 ? -mean_a : mean_a; size_b = mean_b < 0 ? -mean_b : mean_b
  if (size_b < size_a) size_b = size_a
  if (size_a < 0.05 * size_b) size_a = 0.05 * size_b
  for (i = n - window + 1; i <= n && size_b > 0; ++i) {
    off_a = (a[i] < mean_a ? mean_a - a[i] : a[i] - mean_a) / size_a; off_b = (b[i] < mean_b ? mean_b - b[i] : b[i] - mean_b) / size_b
    if (off_a > moved) moved = off_a
    if (off_b > moved) moved = off_b
  }
  if (size_b == 0) moved = 1
  printf "%s %.3g\n", moved <= share ? "settled" : "moving", 100 * moved
}
)AWK";

constexpr std::string_view k_scale = R"AWK(# awk -v density=1.2 -f scale.awk FIELD: prints the field with its uniform vectors multiplied by the density.
{
  rest = $0
  line = ""
  while (match(rest, /uniform \([^)]*\)/)) {
    split(substr(rest, RSTART + 9, RLENGTH - 10), v, " ")
    line = line substr(rest, 1, RSTART - 1) sprintf("uniform (%.12g %.12g %.12g)", v[1] * density, v[2] * density, v[3] * density)
    rest = substr(rest, RSTART + RLENGTH)
  }
  print line rest
}
)AWK";

/// Restores the original fields. Allrun keeps them beside the case while potentialFoam changes them.
constexpr std::string_view k_restore = "restore() { for field in U Phi; do [ ! -f $field.start ] || mv $field.start 0/$field || return 1; done; }\n";

/// The part of Allrun after the variables of steady_variables().
constexpr std::string_view k_steady_run = R"SH(
# Times with results, and files of a function object in the order of the parts.
written() { if [ "$tasks" = 1 ]; then ls; else ls processor0 2> /dev/null; fi | grep -E '^[1-9][0-9]*$' | sort -g; }
latest() { written | tail -n 1; }
files() { for file in postProcessing/$1; do [ -f "$file" ] && echo "$file"; done | sort -t / -k 3,3g; }

# Ends the run if the velocity is out of bounds after iteration $1, and reports where divergence began.
require_bounds() {
  set -- $(awk -f system/judge.awk -v what=bounded -v limit="$limit" -v first="$first_sign" -v from="$1" -v many="$many" $(files 'velocityRange/*/fieldMinMax*.dat'))
  [ "$1" = diverged ] || return 0
  echo "diverged: the largest velocity is $3 m/s at iteration $2, where $limit m/s is the limit; above $first_sign m/s since iteration $4, first at ($5, $6, $7) m"
  echo "see the cells there: sterna draw MESH -o cells.png --cut x=$5 --focus \"$5,$6,$7 radius=$radius\" --color quality; remedies: docs/flow.md of sterna; run Allclean before another run"
  exit 1
}

# Warns if the largest velocity touched the bound in some of the last iterations.
warn_of_bounds() {
  set -- $(awk -f system/judge.awk -v what=bounded -v limit="$limit" -v first="$first_sign" -v from="$watched" -v many="$many" $(files 'velocityRange/*/fieldMinMax*.dat'))
  [ "$1" = touched ] || return 0
  echo "warning: the largest velocity exceeded $limit m/s in $2 of the last 50 iterations, last at ($3, $4, $5) m: do not trust the flow there"
}

# Solves up to iteration $1 and writes the results. Removes earlier results except the last two.
advance() {
  step=$interval
  [ $(($1 % step)) = 0 ] || step=$1
  printf 'endTime %s;\nwriteInterval %s;\n' "$1" "$step" > system/runControl
  if $solver >> "$log" 2>&1; then
    require_bounds "$watched"
  else
    require_bounds 0
    tail -n 30 "$log"
    echo "$solver failed, see $log"
    exit 1
  fi
  for time in $(written | head -n -2); do rm -rf "$time" processor*/"$time"; done
}
is_converged() { tail -n 200 "$log" | grep -q "solution converged"; }

# Succeeds if the tested values stayed within the fraction $2 of their mean over the last $1 iterations; $moved: change in percent.
is_settled() {
  [ -n "$judged" ] || return 1
  set -- $(awk -f system/judge.awk -v what=settled -v window="$1" -v share="$2" -v drag="$drag" -v lift="$lift" $(files "$judged"))
  moved=$2
  [ "$1" = settled ]
}

# Restores fields that potentialFoam changed, if an earlier run was stopped within it.
restore
at=$(latest)
at=${at:-0}
if [ "$at" = 0 ]; then
  : > "$log"
  if [ "$has_potential" = yes ]; then
    # Makes fluxes that conserve mass; without them the first iterations give velocities far above that of the flow. The velocity itself stays uniform,
    # because the velocity that potentialFoam reconstructs from its fluxes is wrong in Debian's OpenFOAM 1912.
    cp 0/U U.start && cp 0/Phi Phi.start && cp system/stage.start system/stage || exit 1
    # Gases need mass fluxes: potentialFoam gets velocities times the density of the free stream.
    [ -z "$density" ] || awk -v density="$density" -f system/scale.awk U.start > 0/U || { restore; exit 1; }
    echo "running potentialFoam"
    potentialFoam -writephi -noFunctionObjects > log.potentialFoam 2>&1 || {
      rm -f 0/phi
      echo "potentialFoam failed, see log.potentialFoam: the run starts from uniform flow"
    }
    [ -z "$density" ] || [ ! -f 0/phi ] || LC_ALL=C sed -i '0,/^dimensions /s/^dimensions .*/dimensions [1 0 -1 0 0 0 0];/' 0/phi || { restore; exit 1; }
    restore && cp system/stage.final system/stage || exit 1
  fi
  [ "$tasks" = 1 ] || run decomposePar decomposePar -force
fi
echo "running $application"
if [ "$start_end" -gt 0 ] && { [ "$at" = 0 ] || cmp -s system/stage system/stage.start; }; then
  cp system/stage.start system/stage
  while [ "$at" -lt "$start_end" ]; do
    at=$(((at / part + 1) * part))
    advance "$at"
    if is_converged || is_settled 50 0.01; then break; fi
  done
  cp system/stage.final system/stage
  echo "second order from iteration $(latest) on"
fi
begin=$at
outcome=over
while [ "$at" -lt "$most" ]; do
  at=$(((at / part + 1) * part))
  [ "$at" -gt "$most" ] && at=$most
  advance "$at"
  if is_converged; then outcome=converged; break; fi
  if [ $((at - begin)) -ge 200 ] && is_settled 200 0.002; then outcome=settled; break; fi
done
case $outcome in
  converged) echo "residuals are below their limits at iteration $(latest)" ;;
  settled) echo "$judged_name moved by $moved % in 200 iterations: settled at iteration $at" ;;
  over) echo "$most iterations are over${has_residuals:+: residuals are above their limits}${moved:+, and $judged_name moved by $moved % over the iterations judged last}" ;;
esac
warn_of_bounds
[ "$tasks" = 1 ] || run reconstructPar reconstructPar -latestTime
)SH";

/// Returns the velocity, m/s, above which a run without bound of the velocity has diverged.
double unbounded_speed(const FoamSetup& setup) { return (setup.has_fast_openings ? k_diverged_inside : k_diverged) * setup.flow.speed; }

/// Returns the velocity, m/s, above which the run has diverged.
double diverged_speed(const FoamSetup& setup) { return setup.is_compressible ? k_near_bound * foam_speed_bound(setup) : unbounded_speed(setup); }

int first_watched(const FoamSetup& setup) { return setup.is_compressible ? k_first_watched_in_gas : k_first_watched; }

class RunFiles {
 public:
  explicit RunFiles(const FoamSetup& setup) : s_(setup), is_parallel_(setup.options.tasks > 1) {}

  std::vector<CaseFile> files() const {
    std::vector<CaseFile> all;
    const auto add = [&](const std::string& path, std::string text, bool is_program = false) {
      all.push_back({.path = path, .text = std::move(text), .is_program = is_program});
    };
    if (s_.options.steady) {
      for (const char* name : {"stage", "stage.final"}) add(std::string("system/") + name, final_stage());
      add("system/stage.start", start_stage());
      add("system/runControl", fmt::format("endTime {};\nwriteInterval {};\n", s_.common.iterations, interval()));
      add("system/judge.awk", std::string(k_judge));
      if (has_mass_fluxes()) add("system/scale.awk", std::string(k_scale));
    }
    add("Allrun", head() + (s_.options.steady ? steady_variables() + std::string(k_restore) + std::string(k_steady_run) + reset_control() : run_in_time()),
        true);
    add("Allclean", clean_script(), true);
    return all;
  }

 private:
  bool has_potential() const { return !s_.is_compressible || s_.flow.mach < 1.0; }
  bool has_mass_fluxes() const { return s_.is_compressible && has_potential(); }
  bool is_in_parts() const { return s_.common.iterations >= k_least_iterations; }
  int part() const { return is_in_parts() ? k_part : s_.common.iterations; }
  /// Returns the iterations between results: at the end of each part, and at the requested interval.
  int interval() const { return std::gcd(part(), std::min(s_.options.write_interval, part())); }

  std::string final_stage() const {
    std::string text =
        "// Second order: Allrun copies stage.start or stage.final here.\nconvectionOfU bounded " + s_.convection() + ";\ncorrection " + s_.correction + ";\n";
    if (s_.is_transonic())
      text +=
          "gradients pointCellsLeastSquares;\ngradientOfU cellLimited pointCellsLeastSquares 0.5;\n// First order for the pressure smears shocks over a tenth "
          "of the chord.\nconvectionOfPressure Gauss limitedLinear 1;\n";
    return text;
  }
  std::string start_stage() const {
    std::string text =
        "// First order, with a correction of normal gradients that is limited to half of the rest: a robust start from uniform flow.\nconvectionOfU bounded "
        "Gauss upwind;\ncorrection limited corrected 0.33;\n";
    if (s_.is_transonic())
      text +=
          "// Limited, so that no value at a face exceeds the values of the cells around: without the limiter the start from uniform flow diverges where "
          "shocks form.\ngradients cellLimited pointCellsLeastSquares 1;\ngradientOfU cellLimited pointCellsLeastSquares 1;\nconvectionOfPressure Gauss "
          "upwind;\n";
    return text;
  }

  std::string head() const {
    return "#!/bin/sh\n# Written by sterna " STERNA_VERSION ". Flow: " + describe(s_.flow) +
           "\ncd \"$(dirname \"$0\")\" || exit 1\n# Debian's packages have no script that sets WM_PROJECT_DIR.\n[ -n \"$WM_PROJECT_DIR\" ] || { [ -d "
           "/usr/share/openfoam ] && export WM_PROJECT_DIR=/usr/share/openfoam; }\nrun() { name=$1; shift; echo \"running $name\"; \"$@\" > \"log.$name\" 2>&1 "
           "|| { tail -n 30 \"log.$name\"; echo \"$name failed, see log.$name\"; exit 1; }; }\n";
  }
  std::string solver() const { return is_parallel_ ? fmt::format("mpirun -np {} {} -parallel", s_.options.tasks, s_.application) : s_.application; }

  std::string run_in_time() const {
    std::string text;
    if (is_parallel_) text += "run decomposePar decomposePar -force\n";
    text += "run " + s_.application + " " + solver() + "\n";
    if (is_parallel_) text += "run reconstructPar reconstructPar -latestTime\n";
    return text;
  }

  bool is_judged_by_forces() const { return s_.settles_by.starts_with("forces"); }
  static std::string along(const Vec3& direction) { return case_number(direction.x) + " " + case_number(direction.y) + " " + case_number(direction.z); }

  std::string steady_variables() const {
    const double limit = diverged_speed(s_);
    std::string text;
    const auto set = [&](const char* name, const std::string& value, const char* what) { text += fmt::format("{}='{}'  # {}\n", name, value, what); };
    set("application", s_.application, "the solver");
    set("solver", solver(), "command that runs the solver");
    set("log", "log." + s_.application, "log of all parts of the run");
    set("tasks", std::to_string(s_.options.tasks), "processes");
    set("most", std::to_string(s_.common.iterations), "iterations at most");
    set("part", std::to_string(part()), "iterations between two tests of convergence");
    set("interval", std::to_string(interval()), "iterations between written results");
    set("start_end", std::to_string(is_in_parts() ? std::max(k_part, s_.common.iterations / 3 / k_part * k_part) : 0),
        "iteration at which the first-order start ends at the latest; 0: no such start");
    set("judged", s_.settles_by, "files of the values that end the run when they have settled; empty: only residuals end the run");
    set("judged_name", is_judged_by_forces() ? "drag or lift" : "the pressure drop", "name of these values");
    set("drag", is_judged_by_forces() ? along(s_.drag_direction()) : "", "directions of drag and lift; empty: one value is tested");
    set("lift", is_judged_by_forces() ? along(s_.lift_direction()) : "", "");
    set("has_residuals", s_.residual_limit() > 0.0 ? "yes" : "", "limits of residuals end the run as well; empty: they do not");
    set("limit", case_number(limit), "m/s, speed above which the run has diverged");
    set("first_sign", case_number(k_first_sign * limit), "m/s, speed that marks the location where divergence began");
    set("many", std::to_string(s_.is_compressible ? k_many_near_bound : 0),
        "number of the last 50 iterations that may exceed the limit: bounded velocities of gases return");
    set("watched", std::to_string(first_watched(s_)), "first iteration at which the velocity is tested; before, the impulse of the start has not faded");
    set("radius", case_number(k_location_radius * s_.flow.length), "m, radius of a picture of that location");
    set("has_potential", has_potential() ? "yes" : "no", "fluxes of potentialFoam at the start; supersonic flow has no such potential");
    set("density", has_mass_fluxes() ? case_number(s_.density) : "", "kg/m^3, density of the free stream: the fluxes are mass fluxes; empty: volume fluxes");
    return text;
  }

  std::string reset_control() const {
    return fmt::format("printf 'endTime %s;\\nwriteInterval %s;\\n' {} {} > system/runControl\n", s_.common.iterations, interval());
  }

  std::string clean_script() const {
    return "#!/bin/sh\n# Removes results and logs; 0/, constant/ and system/ stay.\ncd \"$(dirname \"$0\")\" || exit 1\n" + std::string(k_restore) +
           "restore || exit 1\nrm -rf log.* postProcessing processor[0-9]* "
           "[1-9]* 0.[0-9]* [0-9]*e-[0-9]* 0/phi\n" +
           (s_.options.steady ? "cp system/stage.final system/stage\n" + reset_control() : "");
  }

  const FoamSetup& s_;
  bool is_parallel_;
};

}  // namespace

std::vector<CaseFile> foam_run_files(const FoamSetup& setup) { return RunFiles(setup).files(); }

std::string foam_watch_functions(const FoamSetup& setup) {
  if (!setup.options.steady) return "";
  std::string text = R"(    // The largest velocity and its location at every iteration; Allrun judges it between the parts of the run.
    velocityRange
    {
        type fieldMinMax;
        libs (fieldFunctionObjects);
        mode magnitude;
        fields (U);
        writeControl timeStep;
        writeInterval 1;
        log no;
    }
)";
  if (setup.is_compressible) return text;
  return text + fmt::format(R"(    // A velocity far above that of the flow means divergence: the run ends.
    stopWhereItDiverges
    {{
        type runTimeControl;
        libs (utilityFunctionObjects);
        timeStart {};
        log no;
        conditions {{ velocity {{ type minMax; functionObject velocityRange; fields (max(mag(U))); mode maximum; value {}; }} }}
    }}
)",
                            first_watched(setup), case_number(diverged_speed(setup)));
}

double foam_speed_bound(const FoamSetup& setup) { return k_speed_bound * unbounded_speed(setup); }

}  // namespace sterna::scripting
