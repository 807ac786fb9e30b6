#include "volmesh/case/mesh_case.h"

#include <algorithm>
#include <iterator>

namespace sterna::volmesh {
namespace {

template <class T>
void append(OptionTable& table, T& options, MeshSteps steps) {
  static_assert(Schema<T>::steps != 0, "each options struct of a volume mesh names the step where it may be given");
  if ((Schema<T>::steps & steps) != 0) std::ranges::move(sterna::options_of(options), std::back_inserter(table));
}

}  // namespace

OptionTable options_of(MeshOptions& options, MeshSteps steps) {
  OptionTable table;
  // This is the only list of the option structs. A new struct does not compile until it is added here.
  auto& [family, needles, ridges, envelope, prisms, farfield, ends, size, tetrahedra, improve, limits] = options;
  const auto add = [&](auto&... of_stages) { (append(table, of_stages, steps), ...); };
  add(family, needles, ridges, envelope, prisms, farfield, ends, size, tetrahedra, improve, limits);
  return table;
}

OptionTable options_of(MeshOptions& options) { return options_of(options, k_envelope_step | k_tetrahedra_step | k_finish_step); }

OptionTable required_options_of(MeshCase& mesh_case) {
  OptionTable table = options_of(mesh_case);
  const std::vector<Rule>& rules = mesh_case.patches;
  const bool has_own = std::ranges::any_of(rules, [](const Rule& rule) { return is_set(rule, "first_height"); }) ||
                       (mesh_case.envelope.layers == 0 && std::ranges::none_of(rules, [](const Rule& rule) { return value_or(rule, "layers", 0) > 0; }));
  for (Option& option : table)
    if (option.name == "first_height" && has_own) option.required = false;
  return table;
}

}  // namespace sterna::volmesh
