#include <array>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "io/file/format_table.h"
#include "io/output/atomic_file.h"
#include "scripting/report/report_command.h"
#include "scripting/report/report_data.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/models.h"
#include "scripting/verbs/gate_limits.h"

namespace sterna::scripting {
namespace {

// Fractions of the progress.
constexpr double k_page_read_end = 0.3, k_page_check_end = 0.7;
constexpr double k_megabyte = 1e6;

}  // namespace

std::pair<std::string, bool> page_of_file(const InputPath& input, const ReportOptions& options, const std::vector<std::string>& cuts, const GateTable* limits,
                                          const RunContext& context) {
  const std::string name = std::filesystem::path(input.name).filename().string();
  const RunContext reading = context.part("read", 0.0, k_page_read_end), writing = context.part("report", k_page_check_end, 1.0);
  if (is_model_file(input.path))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "a report of " + input.name,
                 .problem = "the file is a model, which has no mesh yet",
                 .hint = "`sterna surface " + input.name + " -o wall.vtu` meshes the faces of the model, `sterna mesh` the space around it"});
  if (io::format_of(input.path).read_volume) {
    const MeshValue mesh = read_mesh(input, reading);
    if (count_cells(mesh.mesh).total() > 0) {
      mesh.check = check(mesh.mesh, limits ? CheckOptions{.limits = *limits} : CheckOptions{}, context.part("check", k_page_read_end, k_page_check_end));
      return {report_html(mesh, options, cuts, name, writing), !mesh.check->is_valid()};
    }
  }
  if (limits)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "a report of " + input.name,
                 .problem = "--gate has no effect: the file is a surface, and gates apply to volume meshes"});
  if (!cuts.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "a report of " + input.name, .problem = "the file is a surface, which has no cells to cut"});
  surfmesh::StitchOptions stitching;
  stitching.allow_open = true;
  const std::array files = {input};
  return {report_html(read_wall(files, stitching, reading), options, name, writing), false};
}

void require_page_output(const std::filesystem::path& path) {
  if (path.extension() != ".html" && path.extension() != ".htm")
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "writing the report " + path.string(),
                 .problem = "a report is an HTML page",
                 .hint = "give the file a name that ends in .html"});
}

void write_page(const std::string& html, const std::filesystem::path& path, const RunContext& context) {
  io::write_whole(path, html);
  context.info("wrote " + path.string() + ": " + number_text(static_cast<double>(html.size()) / k_megabyte, 3) + " MB");
}

int report_command(const CommandLine& line, const CommandContext& context) {
  const std::string input = line.word("mesh"), output = line.word("output");
  const std::vector<std::string>&cuts = line.all("cut"), &gates = line.all("gate");
  require_page_output(output);
  ReportOptions options;
  set_options(sterna::options_of(options), line.options, context);
  require_report_cuts(cuts);
  GateTable limits;
  for (const std::string& text : gates) set_gate_limits(text, limits);
  const auto [html, is_invalid] = page_of_file({input, input}, options, cuts, gates.empty() ? nullptr : &limits, context.run);
  write_page(html, output, context.run);
  context.console.end_progress();
  return is_invalid ? k_exit_invalid : k_exit_success;
}

}  // namespace sterna::scripting
