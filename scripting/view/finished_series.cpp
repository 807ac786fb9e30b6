#include "scripting/view/finished_series.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "scripting/series/series_report.h"
#include "scripting/view/lua_quoting.h"

namespace sterna::scripting {
namespace {

using CasesJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* k_results_file = "series.json";

/// Returns true if a name in the table refers to a file in the case's folder.
bool is_inside(const fs::path& name) {
  return name.is_relative() && std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

/// Returns the first file of a case with a volume mesh, else with a surface; empty: none.
std::string shown_output(const CasesJson& outputs) {
  std::string surface;
  for (const CasesJson& output : outputs) {
    const std::string name = output.get<std::string>();
    if (!is_inside(name) || !io::is_known_format(name)) continue;
    const io::Format& format = io::format_of(name);
    if (format.read_volume) return name;
    if (format.read_surface && surface.empty()) surface = name;
  }
  return surface;
}

std::string text_in(const CasesJson& entry, const char* name) {
  const auto found = entry.find(name);
  return found != entry.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string script_of(const std::string& entries, std::size_t n) {
  const std::string count = std::to_string(n);
  const std::string choice = n == 1 ? "{ case = 1 }" : "args{ case = number{ 1, min = 1, max = " + count + ", step = 1 } }";
  return "local choice = " + choice + "\nlocal cases = {\n" + entries +
         "}\n"
         "local i = math.floor(choice.case + 0.5)\n"
         "print(\"case \" .. i .. \" of " +
         count +
         ", \" .. cases[i][2])\n"
         "local surface\n"
         "local mesh = read_mesh{ cases[i][1] }\n"
         "if mesh.cells == 0 then\n"
         "  mesh = nil\n"
         "  surface = read_surface{ cases[i][1], allow_open = true }\n"
         "end\n";
}

}  // namespace

bool is_series_folder(const fs::path& folder) { return fs::exists(folder / k_results_file); }

SeriesCases read_series_cases(const fs::path& folder) {
  std::ifstream file(folder / k_results_file, std::ios::binary);
  const CasesJson results = CasesJson::parse(file, nullptr, false);
  if (!results.is_object() || !results.contains("cases") || !results["cases"].is_array())
    throw Error({.code = ErrorCode::file_malformed,
                 .attempted = "showing " + folder.string(),
                 .problem = std::string(k_results_file) + " in this folder is not the table of a series"});
  SeriesCases series;
  CasesJson list = CasesJson::array();
  std::string entries;
  std::size_t n = 0;
  for (const CasesJson& of : results["cases"]) {
    const std::string name = text_in(of, "name");
    const fs::path case_folder = folder / name;
    const CasesJson outputs = of.value("outputs", CasesJson::array());
    CasesJson entry = {{"name", name}, {"case", nullptr}, {"picture", nullptr}, {"gates", CasesJson::object()}};
    for (const char* member : {"parameters", "status", "verdict", "quality", "cells", "result", "error"})
      if (of.contains(member)) entry[member] = of[member];
    if (const std::string output = shown_output(outputs); !output.empty()) {
      const std::string verdict = text_in(of, "verdict");
      const std::string reported = name + ": " + (verdict.empty() ? text_in(of, "status") : verdict) + ", " + text_in(of, "quality");
      entries += "  { " + quoted_for_lua(fs::absolute(case_folder / output).string()) + ", " + quoted_for_lua(reported) + " },\n";
      entry["case"] = ++n;
    }
    for (const CasesJson& output : outputs)
      if (const fs::path picture = output.get<std::string>(); picture.extension() == ".png" && is_inside(picture) && entry["picture"].is_null()) {
        entry["picture"] = series.pictures.size();
        series.pictures.push_back(fs::absolute(case_folder / picture));
      }
    if (fs::exists(case_folder / "quality.json"))
      for (const auto& [gate, state] : gate_states(case_folder)) entry["gates"][gate] = state;
    list.push_back(std::move(entry));
  }
  if (n == 0)
    throw Error({.code = ErrorCode::file_not_found,
                 .attempted = "showing " + folder.string(),
                 .problem = "no case of this series has a mesh or a surface",
                 .hint = "let the function of the series write one: mesh:write(p.name .. \".su2\")"});
  series.script = script_of(entries, n);
  series.json = list.dump(-1, ' ', false, CasesJson::error_handler_t::replace);
  return series;
}

}  // namespace sterna::scripting
