// Entry: reads what the page holds and opens the page for its schema. Whatever goes wrong ends in a sentence on the page, never in a blank one.
import { read_json } from "./data.js";
import { fill, h } from "./dom.js";
import { ReportError, sentence_of } from "./errors.js";
import { ReportApp } from "./report.js";
import { SeriesApp } from "./series.js";

const root = document.getElementById("app");

function show_trouble(error) {
  const text = sentence_of(error);
  if (!root.firstElementChild || root.querySelector(".loading")) fill(root, h("p.fatal", { role: "alert" }, text));
  else root.append(h("p.fatal.below", { role: "alert" }, text));
}

window.addEventListener("error", (event) => show_trouble(event.error ?? event.message));
window.addEventListener("unhandledrejection", (event) => show_trouble(event.reason));

async function start() {
  const json = read_json();
  const apps = { "sterna-report-1": ReportApp, "sterna-series-1": SeriesApp };
  const App = apps[json.schema];
  if (!App) throw new ReportError(`This page shows reports of the schemas ${Object.keys(apps).join(" and ")}; this one has "${json.schema}".`);
  const app = new App(json);
  // Read-only, for tests and for the curious.
  window.sterna = Object.freeze({ state: () => app.test_state(), pixels: () => app.view?.pixels() ?? null });
  await app.start(root);
  document.body.dataset.ready = "true";
}

start().catch((error) => {
  show_trouble(error);
  document.body.dataset.ready = "failed";
  if (!(error instanceof ReportError)) throw error;
});
