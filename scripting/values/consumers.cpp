#include "scripting/values/consumers.h"

#include <algorithm>
#include <array>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "io/file/format_table.h"

namespace sterna::scripting {
namespace {

struct SolverName {
  std::string_view name;
  Consumers consumers;
};
constexpr std::array k_solver_names = {
    SolverName{"su2", k_node_centred_alone},    SolverName{"tau", k_node_centred_alone},          SolverName{"edge", k_node_centred_alone},
    SolverName{"fun3d", k_node_centred_alone},  SolverName{"node-centred", k_node_centred_alone}, SolverName{"openfoam", k_cell_centred_alone},
    SolverName{"fluent", k_cell_centred_alone}, SolverName{"cell-centred", k_cell_centred_alone}, SolverName{"all", Consumers{}}};

void add_consumers(Consumers& to, const Consumers& more) {
  to.cell_centred = to.cell_centred || more.cell_centred;
  to.node_centred = to.node_centred || more.node_centred;
}

constexpr Consumers k_nobody{.cell_centred = false, .node_centred = false};

}  // namespace

std::string known_solvers() {
  std::string text;
  for (const SolverName& solver : k_solver_names) text += (text.empty() ? "" : ", ") + std::string(solver.name);
  return text;
}

Consumers consumers_of_solvers(std::string_view list, Consumers usual, std::string_view option) {
  if (list == "automatic") return usual;
  Consumers consumers = k_nobody;
  std::string_view rest = list;
  do {
    const std::string_view name = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), name.size() + 1));
    const auto* const solver = std::ranges::find(k_solver_names, name, &SolverName::name);
    if (solver == k_solver_names.end())
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = std::string(option) + " \"" + std::string(list) + "\"",
                   .problem = "\"" + std::string(name) + "\" is not a known solver",
                   .hint = "known are " + known_solvers() + "; several are separated by commas"});
    add_consumers(consumers, solver->consumers);
  } while (!rest.empty());
  return consumers;
}

Consumers consumers_of_files(std::span<const std::filesystem::path> files) {
  if (files.empty()) return {};
  Consumers consumers = k_nobody;
  for (const std::filesystem::path& file : files) add_consumers(consumers, io::format_of(file).consumers);
  return consumers;
}

}  // namespace sterna::scripting
