#include "scripting/verbs/wrap_verbs.h"

#include <array>

#include "scripting/lua/verb_tools.h"
#include "scripting/values/wrap_surfaces.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_wrap_usage = "wrap{ \"torn.stl\", \"tail.stl\", edge = 5*cm, gap = 20*cm }";

std::string wrap_help() {
  surfmesh::WrapOptions options;
  return options_help(sterna::options_of(options));
}

ScriptValue wrap_parts(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_wrap_usage);
  surfmesh::WrapOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  std::vector<UnionItem> items;
  std::size_t number = 0;
  for (const ScriptValue& item : reader.items()) {
    ++number;
    if (const auto* surface = std::get_if<SurfaceHandle>(&item)) items.emplace_back(*surface);
    else if (const auto* name = std::get_if<std::string>(&item)) items.emplace_back(find_input(call, *name));
    else reader.add_problem("entry " + std::to_string(number) + ": expected a surface or a file name, not " + std::string(type_text(item)));
  }
  if (number == 0) reader.add_problem("needs a surface or a file name");
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  return std::make_shared<const SurfaceValue>(wrap_surfaces(items, options, call.session.reuse(), call.session.context.part("wrap", 0.0, 1.0)));
}

constexpr std::array<ScriptVerb, 1> k_wrap_verbs = {{
    {"wrap", k_wrap_usage,
     "Wraps damaged surfaces in one closed surface close to them, with their sharp edges and patches. Reports what was closed and what disappeared inside.",
     wrap_parts, wrap_help, true, "surface"},
}};

}  // namespace

std::span<const ScriptVerb> wrap_verbs() { return k_wrap_verbs; }

}  // namespace sterna::scripting
