// The log of the runs, updated during a run.
import { fill, h } from "../dom.js";

const k_most = 400;

export function log_tab(bench) {
  const list = h("div.log", { id: "log", role: "log" });
  let drawn = -1;
  const refresh = () => {
    if (drawn === bench.n_lines) return;
    const is_at_end = list.parentElement ? list.parentElement.scrollTop + list.parentElement.clientHeight > list.parentElement.scrollHeight - 40 : true;
    drawn = bench.n_lines;
    fill(list, bench.lines.slice(-k_most).map(({ run, warns, text }) => h(`div.log_line${warns ? ".warns" : ""}`, null, h("small", null, `${run} `), text)));
    if (is_at_end) list.lastChild?.scrollIntoView({ block: "end" });
  };
  bench.on_in_tab("log", ["news"], refresh);
  refresh();
  return list;
}
