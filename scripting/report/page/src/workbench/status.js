// The line at the top: the file, the state of its run, and the main buttons.
import { chip } from "../banner.js";
import { button, fill, h, percent_text, seconds_text } from "../dom.js";
import { sentence_of } from "../errors.js";
import { post } from "./server.js";

const k_modes = { sketch: "sketch", geometry: "geometry", mesh: "mesh" };
const k_states = { done: "pass", failed: "fail", running: "not checked", stopped: "warn", starting: "not checked" };

export function status_line(bench) {
  const title = h("h1");
  const words = h("span.status_words", { id: "status", role: "status" });
  const bar = h("span.progress", { role: "progressbar", "aria-valuemin": 0, "aria-valuemax": 100, hidden: true }, h("i"));
  const mesh = button("Mesh now", () => bench.mesh_now(), { title: "Run the whole script: meshes are made, files are written (key M)", id: "mesh_now" });
  const stop = button("Stop", () => post("stop", {}).catch((error) => bench.say_for_a_while(sentence_of(error))), { title: "Stop the run", id: "stop" });
  const again = button("Again", () => post("run", { mode: "geometry" }).catch((error) => bench.say_for_a_while(sentence_of(error))), { title: "Run the script again, geometry only", id: "run_again" });
  const cases = button("Cases", () => bench.cases?.show(!bench.state.get("is_in_cases")), { title: "Pictures and table of the series' cases (key C)", id: "show_cases", pressed: false });
  cases.hidden = true;
  bench.state.on(["is_in_cases"], ({ is_in_cases }) => cases.setAttribute("aria-pressed", String(is_in_cases)));
  const refresh = ({ news }) => {
    if (!news) return;
    const { run } = news;
    const is_running = run.status === "running";
    title.textContent = news.file;
    cases.hidden = !news.has_cases;
    stop.hidden = !is_running;
    again.hidden = is_running;
    bar.hidden = !is_running;
    bar.firstChild.style.width = `${(100 * run.share).toFixed(1)}%`;
    bar.setAttribute("aria-valuenow", (100 * run.share).toFixed(0));
    const rest = is_running
      ? [run.stage.replaceAll("/", " \u203a "), run.share > 0 ? ` ${percent_text(run.share)}` : "", typeof run.left === "number" ? `, ${seconds_text(run.left)} left` : ""]
      : [` in ${seconds_text(run.seconds)}`];
    fill(words, h(`span.chip.${{ pass: "pass", fail: "fail", warn: "warn" }[k_states[run.status]] ?? "unknown"}`, null, run.status), ` ${k_modes[run.mode] ?? ""}${is_running ? ": " : ""}`, rest);
  };
  bench.state.on(["news"], refresh);
  return h("header.banner", null, h("div.banner_title", null, title, h("span.program", null, "sterna view")), h("div.status_box", null, words, bar), h("div.buttons", null, cases, stop, again, mesh));
}

export { chip };
