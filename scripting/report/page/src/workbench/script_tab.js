// The script as stored on disk, with error messages at their lines.
import { fill, h } from "../dom.js";
import { ReportError } from "../errors.js";
import { get_script } from "./server.js";

export function script_tab(bench) {
  const body = h("div", { id: "script_tab" });
  let loaded = "", text = "";
  const lines_of = (news) => {
    // Messages contain the name of the script as given; lines of a module are not lines of the script.
    const name = news.file;
    const here = new Map();
    for (const problem of news.problems) if (problem.line > 0 && problem.file.endsWith(name)) here.set(problem.line, [...(here.get(problem.line) ?? []), problem.text]);
    return here;
  };
  const draw = () => {
    const { news } = bench.state.values;
    const here = lines_of(news);
    const elsewhere = news.problems.filter((problem) => !(problem.line > 0 && problem.file.endsWith(news.file)));
    const objects = new Map();
    for (const object of news.objects) if (object.line) objects.set(object.line, [...(objects.get(object.line) ?? []), object.key]);
    const rows = text.split("\n").map((line, k) => [
      h(`div.code_line${here.has(k + 1) ? ".bad" : ""}`, { id: `line_${k + 1}` }, h("span.line_number", null, String(k + 1)), h("code", null, line || " "), objects.has(k + 1) ? h("small.line_object", null, objects.get(k + 1).join(", ")) : null),
      (here.get(k + 1) ?? []).map((problem) => h("div.line_problem", { role: "alert" }, problem)),
    ]);
    fill(body, elsewhere.map((problem) => h("p.note.wrong", { role: "alert" }, problem.text)), h("div.code", null, rows));
    if (bench.state.get("tab") === "script") body.querySelector(".line_problem")?.scrollIntoView({ block: "center" });
  };
  const refresh = async () => {
    const { news, tab } = bench.state.values;
    if (!news || tab !== "script") return;
    const signature = `${news.run.number} ${news.run.status} ${JSON.stringify(news.problems)} ${news.objects.length}`;
    if (signature === loaded) return;
    loaded = signature;
    try {
      text = await get_script();
      draw();
    } catch (error) {
      if (!(error instanceof ReportError)) throw error;
      fill(body, h("p.note.wrong", null, error.message));
    }
  };
  bench.state.on(["news", "tab"], refresh);
  refresh();
  return body;
}
