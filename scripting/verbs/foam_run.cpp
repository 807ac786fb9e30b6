// Steps of Allrun in a steady case: potentialFoam for fluxes that conserve mass, a start of first order in parts of some iterations until forces settle, the
// rest of second order in parts until they settle again. Between the parts judge.awk reads what the function objects have written.
#include "scripting/verbs/foam_run.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/volume/volume_foam.h"

namespace sterna::scripting {
namespace {

constexpr int k_part = 50;              ///< iterations from one judgement to the next
constexpr int k_start_window = 50;      ///< iterations over which forces move by less than ...
constexpr double k_start_share = 0.01;  ///< ... this share: the start has settled
constexpr int k_final_window = 200;     ///< the same of the rest
constexpr double k_final_share = 0.002;
constexpr int k_least_iterations = 150;        ///< of a run that has a start of its own
constexpr double k_most_of_start = 1.0 / 3.0;  ///< of all iterations
constexpr double k_wild_speed = 10.0;          ///< over the free stream's: no flow round a body has such a velocity
constexpr double k_first_sign = 5.0;           ///< the same: where divergence is seen first
constexpr int k_first_watched = 15;            ///< iterations: the impulse of the start has faded

constexpr std::string_view k_judge = R"AWK(# Reads what function objects wrote, one value or force for each iteration, and judges it.
# awk -f judge.awk -v what=settled -v window=200 -v share=0.002 FILES   prints "settled PERCENT", "moving PERCENT" or "short"
# awk -f judge.awk -v what=wild -v limit=680 -v first=340 -v from=15 FILES  prints "wild ITERATION SPEED FIRST_ITERATION X Y Z" or "bounded SPEED"
/^#/ { next }
{ gsub(/[()]/, " ") }
what == "wild" {
  # Time mag U MIN X Y Z [PROCESSOR] MAX X Y Z [PROCESSOR]
  p = NF > 11 ? 9 : 8
  speed = $p; time = $1 + 0
  if (time < from) next
  bad = (speed + 0 != speed + 0) || speed ~ /nan|inf/ || speed + 0 > first
  if (bad && !n_first) { n_first = time; x = $(p + 1); y = $(p + 2); z = $(p + 3) }
  if (!bad) n_first = 0
  if (speed ~ /nan|inf/ || speed + 0 > limit) { if (!n_wild) { n_wild = time; wild_speed = speed } }
  last = speed
  next
}
{
  if ($1 + 0 <= last_time) next
  last_time = $1 + 0
  ++n
  fx[n] = $2; fy[n] = NF > 3 ? $3 : 0; fz[n] = NF > 3 ? $4 : 0
}
END {
  if (what == "wild") {
    if (n_wild) print "wild", n_wild, wild_speed, n_first, x, y, z
    else print "bounded", last
    exit
  }
  if (n < window) { print "short"; exit }
  for (i = n - window + 1; i <= n; ++i) { mx += fx[i] / window; my += fy[i] / window; mz += fz[i] / window }
  size = sqrt(mx * mx + my * my + mz * mz)
  for (i = n - window + 1; i <= n; ++i) {
    off = sqrt((fx[i] - mx) ^ 2 + (fy[i] - my) ^ 2 + (fz[i] - mz) ^ 2)
    if (off > most) most = off
  }
  moved = size > 0 ? most / size : 1
  printf "%s %.3g\n", moved <= share ? "settled" : "moving", 100 * moved
}
)AWK";

constexpr std::string_view k_functions = R"SH(
run() { name=$1; shift; echo "running $name"; "$@" > "log.$name" 2>&1 || { tail -n 30 "log.$name"; echo "$name failed, see log.$name"; exit 1; }; }
)SH";

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
      add("system/runControl", run_control(s_.common.iterations, interval()));
      add("system/judge.awk", std::string(k_judge));
    }
    add("Allrun", s_.options.steady ? steady_script() : script_in_time(), true);
    add("Allclean", clean_script(), true);
    return all;
  }

 private:
  static std::string convection(const FoamSetup& s) {
    return s.model == "laminar" && !s.is_compressible ? "bounded Gauss linearUpwind grad(U)" : "bounded Gauss linearUpwindV grad(U)";
  }

  std::string final_stage() const {
    return "// Second order: Allrun copies stage.start or stage.final here; docs/flow.md.\nconvectionOfU " + convection(s_) + ";\ncorrection " + s_.correction +
           ";\n";
  }
  std::string start_stage() const {
    return "// First order, and a correction for faces that lean which is never above a third of the rest: what a start from uniform flow survives.\n"
           "convectionOfU bounded Gauss upwind;\ncorrection limited corrected 0.33;\n";
  }
  int interval() const { return std::min(s_.options.write_interval, s_.common.iterations); }
  static std::string run_control(int end, int interval) { return fmt::format("endTime {};\nwriteInterval {};\n", end, interval); }

  std::string head() const {
    return "#!/bin/sh\n# Written by sterna " STERNA_VERSION ". Flow: " + describe(s_.flow) +
           "\ncd \"$(dirname \"$0\")\" || exit 1\n"
           "# Packages of Debian have no script that sets it.\n[ -n \"$WM_PROJECT_DIR\" ] || { [ -d /usr/share/openfoam ] && export "
           "WM_PROJECT_DIR=/usr/share/openfoam; }\n" +
           std::string(k_functions);
  }
  std::string solver() const { return is_parallel_ ? fmt::format("mpirun -np {} {} -parallel", s_.options.tasks, s_.application) : s_.application; }

  std::string script_in_time() const {
    std::string text = head() + "\n";
    if (is_parallel_) text += "run decomposePar decomposePar -force\n";
    text += "run " + s_.application + " " + solver() + "\n";
    if (is_parallel_) text += "run reconstructPar reconstructPar -latestTime\n";
    return text;
  }

  std::string steady_script() const {
    std::string text = head();
    const int most = s_.common.iterations;
    const bool has_start = most >= k_least_iterations;
    text += fmt::format("solver=\"{}\"\nlog=log.{}\nmost={}\n", solver(), s_.application, most);
    text += R"SH(
files() { for at in $(ls "postProcessing/$1" 2>/dev/null | sort -g); do ls postProcessing/"$1"/"$at"/*.dat; done; }
judge() { awk -f system/judge.awk "$@"; }
# The run ends here where the velocity is out of bounds, and says where that began.
require_bounds() {
)SH";
    text += fmt::format("  set -- $(judge -v what=wild -v limit={} -v first={} -v from={} $(files velocityRange))\n", case_number(k_wild_speed * s_.flow.speed),
                        case_number(k_first_sign * s_.flow.speed), k_first_watched);
    text += fmt::format(
        "  [ \"$1\" = wild ] || return 0\n"
        "  echo \"diverged: the largest velocity is $3 m/s at iteration $2, more than {:g} times the free stream's; above {:g} times it since iteration $4, "
        "first at "
        "($5, $6, $7) m\"\n"
        "  echo \"look at the cells there: sterna draw MESH -o cells.png --cut x=$5 --focus \\\"$5,$6,$7 radius={}\\\" --color quality; what helps: "
        "docs/flow.md\"\n"
        "  exit 1\n}}\n",
        k_wild_speed, k_first_sign, case_number(0.02 * s_.flow.length));
    text += R"SH(# Solves up to iteration $1, writes results there. Ends all where the solver fails.
advance() {
  printf 'endTime %s;\nwriteInterval %s;\n' "$1" "$2" > system/runControl
  $solver >> "$log" 2>&1
  status=$?
  require_bounds
  [ $status = 0 ] || { tail -n 30 "$log"; echo "$solver failed, see $log"; exit 1; }
  [ -n "$before" ] && rm -rf "$before" processor*/"$before"
  before=$1
}
is_converged() { tail -n 200 "$log" | grep -q "solution converged"; }
)SH";
    text += "\n";
    if (is_parallel_) text += "latest() { ls processor0 | grep -E '^[0-9]+$' | sort -g | tail -n 1; }\n";
    else text += "latest() { ls | grep -E '^[0-9]+$' | sort -g | tail -n 1; }\n";
    text += "at=0\n";
    text += is_parallel_ ? "[ -d processor0 ] && at=$(latest)\n" : "at=$(latest)\n";
    text += "if [ \"$at\" = 0 ]; then\n  : > \"$log\"\n" + initial_fluxes();
    if (is_parallel_) text += "  run decomposePar decomposePar -force\n";
    text += "fi\necho \"running " + s_.application + "\"\n";
    if (!has_start) {
      text += fmt::format("advance $most {}\n", interval());
    } else {
      const int most_of_start = std::max(k_part, static_cast<int>(k_most_of_start * most) / k_part * k_part);
      text +=
          fmt::format("cp system/stage.start system/stage\nwhile [ \"$at\" -lt {} ]; do\n  at=$((at + {}))\n  advance $at {}\n", most_of_start, k_part, k_part);
      text += "  is_converged && break\n";
      text += settled("  ", k_start_window, k_start_share, "break");
      text += "done\ncp system/stage.final system/stage\necho \"second order from iteration $at on\"\nbegin=$at\n";
      text += fmt::format("while [ \"$at\" -lt $most ]; do\n  at=$((at + {0}))\n  [ \"$at\" -gt $most ] && at=$most\n  advance $at {0}\n", k_part);
      text += "  is_converged && { echo \"residuals are below their limits at iteration $(latest)\"; break; }\n";
      text += fmt::format("  [ $((at - begin)) -lt {} ] && continue\n", k_final_window);
      text += settled("  ", k_final_window, k_final_share,
                      "echo \"forces moved by $2 % in " + std::to_string(k_final_window) + " iterations: settled at iteration $at\"; break");
      text += "done\n[ \"$1\" = moving ] && echo \"forces still moved by $2 % in the last " + std::to_string(k_final_window) + " iterations: not settled\"\n";
    }
    if (is_parallel_) text += "run reconstructPar reconstructPar -latestTime\n";
    return text + fmt::format("printf 'endTime %s;\\nwriteInterval %s;\\n' {} {} > system/runControl\nexit 0\n", most, interval());
  }

  /// Judges forces, or the pressure drop of internal flows; nothing where there are neither.
  std::string settled(const std::string& indent, int window, double share, const std::string& then) const {
    if (s_.settles_by.empty()) return "";
    return indent + fmt::format("set -- $(judge -v what=settled -v window={} -v share={} $(files {}))\n", window, case_number(share), s_.settles_by) + indent +
           "[ \"$1\" = settled ] && { " + then + "; }\n";
  }

  std::string initial_fluxes() const {
    if (s_.is_compressible) return "";
    return "  # Fluxes that conserve mass to start with, or the first iterations throw velocities far off. The velocity itself stays uniform: what\n"
           "  # potentialFoam reconstructs from its fluxes is wrong in Debian's OpenFOAM 1912.\n"
           "  cp 0/U U.start && cp 0/Phi Phi.start && cp system/stage.start system/stage\n  echo \"running potentialFoam\"\n"
           "  potentialFoam -writephi -noFunctionObjects > log.potentialFoam 2>&1 || { rm -f 0/phi; echo \"potentialFoam failed, see log.potentialFoam: the "
           "run starts "
           "from uniform flow\"; }\n"
           "  mv U.start 0/U && mv Phi.start 0/Phi && cp system/stage.final system/stage\n";
  }

  std::string clean_script() const {
    std::string text =
        "#!/bin/sh\n# Results and logs; 0/, constant/ and system/ stay.\ncd \"$(dirname \"$0\")\" || exit 1\nrm -rf log.* postProcessing "
        "processor[0-9]* [1-9]* 0.[0-9]* [0-9]*e-[0-9]* 0/phi U.start Phi.start\n";
    if (s_.options.steady)
      text += fmt::format("cp system/stage.final system/stage\nprintf 'endTime %s;\\nwriteInterval %s;\\n' {} {} > system/runControl\n", s_.common.iterations,
                          interval());
    return text;
  }

  const FoamSetup& s_;
  bool is_parallel_;
};

}  // namespace

std::vector<CaseFile> foam_run_files(const FoamSetup& setup) { return RunFiles(setup).files(); }

std::string foam_watch_functions(const FoamSetup& setup) {
  if (!setup.options.steady) return "";
  return "    // The largest velocity and its place at every iteration; far beyond the free stream's the run ends, and Allrun says where it began.\n"
         "    velocityRange\n    {\n        type fieldMinMax;\n        libs (fieldFunctionObjects);\n        mode magnitude;\n        fields (U);\n        "
         "writeControl timeStep;\n        writeInterval 1;\n        log no;\n    }\n"
         "    stopWhereItDiverges\n    {\n        type runTimeControl;\n        libs (utilityFunctionObjects);\n        timeStart " +
         std::to_string(k_first_watched) +
         ";\n        log no;\n        conditions { velocity { type minMax; functionObject velocityRange; fields (max(mag(U))); mode maximum; value " +
         case_number(k_wild_speed * setup.flow.speed) + "; } }\n    }\n";
}

}  // namespace sterna::scripting
