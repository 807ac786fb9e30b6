// Options of a volume mesh made in steps: each is accepted at the step in which it has an effect; options of the outer boundary also at the next step.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {
namespace {

TEST(MeshSteps, EachOptionBelongsToOneStep) {
  MeshCase mesh_case;
  std::map<std::string, std::set<int>> steps;  // by full name
  for (const MeshSteps step : {k_envelope_step, k_tetrahedra_step, k_finish_step})
    for (const Option& option : options_of(mesh_case, step)) steps[std::string(option.stage) + "." + std::string(option.name)].insert(step);
  const OptionTable all = options_of(mesh_case);
  EXPECT_EQ(steps.size(), all.size());
  for (const Option& option : all) {
    const std::set<int> own = steps[std::string(option.stage) + "." + std::string(option.name)];
    if (option.stage == "farfield" || option.stage == "limits")  // the envelope and the tetrahedra both depend on the farfield, and both need memory
      EXPECT_EQ(own, (std::set<int>{k_envelope_step, k_tetrahedra_step})) << option.name;
    else EXPECT_EQ(own.size(), 1u) << option.stage << "." << option.name;
  }
}

TEST(MeshSteps, StagesAreWhereTheyAreUsed) {
  MeshCase mesh_case;
  const auto has = [&](MeshSteps step, std::string_view stage) {
    const OptionTable table = options_of(mesh_case, step);
    return std::any_of(table.begin(), table.end(), [&](const Option& option) { return option.stage == stage; });
  };
  EXPECT_TRUE(has(k_envelope_step, "family") && has(k_envelope_step, "envelope"));
  EXPECT_TRUE(has(k_tetrahedra_step, "ends") && has(k_tetrahedra_step, "prisms") && has(k_tetrahedra_step, "size") && has(k_tetrahedra_step, "tetrahedra"));
  EXPECT_TRUE(has(k_finish_step, "improve"));
}

}  // namespace
}  // namespace sterna::volmesh
